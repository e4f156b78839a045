#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Array>
#include <osg/Group>
#include <osg/Matrix>
#include <osg/observer_ptr>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgTSS {

class PairBodies;

/// A graph as it was when its tables were installed: of each group its children, of each geometry its
/// vertices and primitive sets (which, and how often they were said to be dirty), of each transform that
/// nothing is known to move its matrix, unless it carries all that joints hold together. What has become
/// other concerns the tables if it was part of a body of a pair, parts the two bodies of one, or may touch
/// one at some pose of the joints. If not, the graph is remembered as it is then, and what has come may
/// change and go again as long as it meets nothing. What moves by itself, what osgTSS shows and what is paged
/// does not count.
class StandingParts {
public:
    /// model: whose pairs have been installed in the graph.
    StandingParts(osg::Node& root, const tss::SceneModel& model);

    /// Looks at some of it, at all in the course of 64 calls, and says what has become other and concerns the
    /// tables; once, then it looks no more.
    std::optional<std::string> changed();

    /// Whether anything is other than it was, of concern or not.
    bool anyOther() const { return std::ranges::any_of(_parts, isOther); }

private:
    /// Whether they are the same is told without looking at each.
    struct Drawn {
        const osg::Array* vertices = nullptr;
        unsigned int count = 0, modified = 0;
        std::size_t primitives = 0; ///< a number that is another for other primitive sets
        friend bool operator==(const Drawn&, const Drawn&) = default;
    };
    struct Child {
        osg::observer_ptr<osg::Node> node;
        bool known; ///< tables know something that is drawn there, in the body that the group is part of
    };
    struct Part {
        osg::observer_ptr<osg::Node> node;
        bool known; ///< as of a child
        Drawn drawn;
        std::vector<Child> children{};
        std::optional<osg::Matrix> place{};
    };
    class Collect;

    static Drawn drawnBy(const osg::Node& node);
    bool cameSince(osg::Node& node) const;
    static bool isOther(const Part& part);
    std::string whatConcerns(const Part& part, PairBodies& bodies);

    osg::Node& _root;
    const tss::SceneModel& _model;
    std::vector<Part> _parts;
    std::map<const osg::Node*, osg::observer_ptr<osg::Node>> _since; ///< what came, and was of no concern
    std::size_t _next = 0, _pause = 0;                               ///< calls that nothing is looked at in
};

} // namespace osgTSS
