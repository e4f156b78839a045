#pragma once
#include <osg/Group>
#include <osg/observer_ptr>

#include <optional>
#include <string>
#include <vector>

namespace osgTSS {

/// What a graph draws, and the transforms that place it, as they were when this was made: tables and proofs
/// know parts as they were baked. Of what moves by itself, of what osgTSS shows and of what is paged it knows
/// nothing, nor of a transform that carries all there is alike.
class StandingParts {
public:
    explicit StandingParts(osg::Node& root);

    /// Looks at some of it, at all in the course of 64 calls, and says what is other than it was; once, then
    /// it looks no more.
    std::optional<std::string> changed();

private:
    struct Part {
        osg::observer_ptr<osg::Node> node;
        bool fixed; ///< a transform that nothing is known to move
        std::size_t number;
    };
    class Collect;

    static std::size_t numberOf(const osg::Node& node, bool fixed);

    std::vector<Part> _parts;
    std::size_t _next = 0;
};

} // namespace osgTSS
