#pragma once
#include "ContactReport.h"
#include "SkeletonPose.h"
#include "osgTSS/src/SceneCache.h"
#include "osgTSS/src/joints/JointNodes.h"

#include <osg/Node>
#include <osgTSS/Scene>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgTSS {

/// The joints of some pairs on the nodes that carry them, at and below the node that a JointCallback stands
/// on (the owner), and where these joints are.
class JointBinding {
public:
    /// before: what stood here until now; where it is of the same scene the joints go on from where it has
    /// them, so that none goes through anything meanwhile. Null at the start.
    JointBinding(osg::Node& owner, const Scene& scene, const std::vector<std::string>& pairPaths,
                 JointBinding* before);

    /// The scene and the nodes are still those that this was made for.
    bool fits(const Scene& scene) const;

    /// Writes what was asked for last back onto the nodes, before the animation writes.
    void restoreAsked() const;
    /// Warns once of each joint that goes beyond what its tables are for. Pairs of a joint that stands where
    /// they know nothing are let go while it does.
    void watch(const Scene& scene, const std::vector<std::string>& pairPaths);
    /// Moves the joints towards what their nodes ask for, as far as no table says contact.
    void resolve();
    /// Writes where the joints are onto the nodes.
    void show() const;
    /// Whether the nodes ask for other values than at the last resolve(), and than it came to.
    bool movedSince() const;
    /// The contacts that the last resolve() found.
    ToldContacts contacts(const Scene& scene, osg::NodeVisitor& visitor);

    unsigned int traversal = 0, frame = 0; ///< of the last update
    bool updated = false;                  ///< there was one

private:
    /// A joint of the pairs, its node, and how that is reached from the owner.
    struct Bound {
        std::unique_ptr<JointNode> access;        ///< null: its pairs are not kept apart
        osg::NodePath path;                       ///< from the owner to the joint's node
        std::vector<const osg::Node*> transforms; ///< of these, to be compared only: they may be gone later
        bool served = true;                       ///< false while it stands where no table of its knows it
        bool told = false;                        ///< a warning that it went beyond its limits was given

        bool isOn(const osg::Node& node) const;
        bool inPlace() const;
    };

    void bind(osg::Node& owner, int joint, osg::Node* node, JointBinding* before);
    void choose(const Scene& scene, const std::vector<std::string>& pairPaths);
    std::vector<double> valuesOf(std::size_t joint) const;
    void warnBeyondLimits();
    void warnOnce(int joint, const Stray& stray);

    std::shared_ptr<const tss::SceneModel> _model; ///< that the rest was made from
    std::map<int, Bound> _bound;                   ///< by the model's joint
    std::shared_ptr<SharedPlan> _plan;             ///< of the pairs that are kept apart now
    std::vector<JointNode*> _joints;               ///< of the plan's
    std::vector<double> _q;                        ///< where the joints are
    std::vector<double> _asked;                    ///< room for what is asked
    std::vector<double> _askedLast;                ///< at the last resolve()
    std::vector<tss::GroupAnswer> _answers;        ///< of the last resolve()
    ContactReport _report;                         ///< carried on when other pairs are kept apart
    std::optional<SkeletonPose> _skeletons;        ///< where some joint is a bone
};

} // namespace osgTSS
