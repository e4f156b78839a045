#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Group>
#include <osg/observer_ptr>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgTSS {

class PairBodies;

/// What a graph draws, and the transforms that place it, as they were when this was made: tables and proofs
/// know parts as they were baked. Of what moves by itself, of what osgTSS shows and of what is paged it knows
/// nothing, nor of a transform that carries all there is alike.
class StandingParts {
public:
    /// model: whose pairs have been installed in the graph.
    StandingParts(osg::Node& root, const tss::SceneModel& model);

    /// Looks at some of it, at all in the course of 64 calls, and says what is other than it was, if that is
    /// part of a body of a pair or may touch one; once, then it looks no more.
    std::optional<std::string> changed();

    /// Whether anything is other than it was, of concern or not.
    bool anyOther() const {
        return std::ranges::any_of(_parts, [&](const Part& part) { return isOther(part); });
    }

private:
    struct Part {
        osg::observer_ptr<osg::Node> node;
        bool fixed; ///< a transform that nothing is known to move
        bool known; ///< tables know it, or of a transform something below it
        std::size_t number;
        /// And whether tables know what is drawn there. One that is gone may have another at its address.
        std::vector<std::pair<osg::observer_ptr<osg::Node>, bool>> children{};
    };
    class Collect;

    bool cameSince(osg::Node& node) const;
    static std::size_t numberOf(const osg::Node& node, bool fixed);
    bool isOther(const Part& part) const;
    std::string whatConcerns(const Part& part, PairBodies& bodies);
    bool childConcerns(const Part& part, const osg::NodePath& path, PairBodies& bodies);

    osg::Node& _root;
    const tss::SceneModel& _model;
    std::vector<Part> _parts;
    std::map<const osg::Node*, osg::observer_ptr<osg::Node>>
        _since;                        ///< what came later, and is of no concern
    std::size_t _next = 0, _pause = 0; ///< calls that nothing is looked at in
};

} // namespace osgTSS
