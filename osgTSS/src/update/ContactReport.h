#pragma once
#include "osgTSS/src/draw/BodyNodes.h"

#include "bake/play/JointPlan.h"

#include <osg/observer_ptr>
#include <osgTSS/ContactCallback>
#include <osgTSS/Scene>

#include <vector>

namespace osgTSS {

/// Tells of the contacts of the joints that one callback resolves below one node.
class ContactReport {
public:
    /// After joints were resolved to q, with these answers, one per group of the plan. What held a joint
    /// touches.
    void tell(const Scene& scene, const tss::JointPlan& plan, const std::vector<double>& q,
              const std::vector<tss::GroupAnswer>& answers, ContactCallback& callback,
              osg::NodeVisitor& visitor);

private:
    struct Side {
        osg::observer_ptr<osg::Node> node;
        double scale = 1;
    };
    /// A pair and what was last told of it.
    struct Watched {
        int pair = -1;
        Side a, b;
        bool touching = false;
        Contact last;
    };

    void watch(const Scene& scene, const tss::JointPlan& plan, osg::NodeVisitor& visitor);
    static void locate(const tss::SceneModel& model, const tss::JointPlan& plan, const std::vector<double>& q,
                       Watched& watched);

    std::vector<std::vector<Watched>> _groups; ///< as the plan's
};

} // namespace osgTSS
