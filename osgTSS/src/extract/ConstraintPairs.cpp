#include "SkeletonMeshes.h"
#include "SoftParts.h"
#include "osgTSS/src/joints/AnimationChannels.h"

#include "bake/base/Error.h"
#include "bake/model/JointGraph.h"
#include "bake/motion/MotionBound.h"

#include <osg/Notify>
#include <osgTSS/ConstraintVisitor>

#include <algorithm>

// Which of the bodies that were found are pairs.
namespace osgTSS {

/// A pair of two bodies by the joints between them; not where those have more DOFs than a table can.
void ConstraintVisitor::addPair(int a, int b, const std::vector<int>& joints) {
    tss::Pair pair;
    pair.bodyA = a;
    pair.bodyB = b;
    pair.joints = joints;
    std::size_t dofs = 0;
    for (int joint : pair.joints) dofs += _model.joints[joint].dofs.size();
    if (dofs > tss::maxDofs) {
        ++_tooManyDofs;
        return;
    }
    try {
        tss::checkMotion(tss::pairMotion(_model, pair));
    } catch (const tss::InputError& error) {
        if (!_quiet)
            OSG_WARN << "osgTSS: the pair of " << _model.bodies[a].path << " and " << _model.bodies[b].path
                     << " is left out: " << error.message << std::endl;
        return;
    }
    if (pair.joints.size() == 1) {
        pair.path = _model.joints[pair.joints[0]].path;
    } else {
        pair.path = freePath(_model.bodies[b].displayName + "Pair");
    }
    _model.pairs.push_back(pair);
}

/// a stands before b.
bool ConstraintVisitor::wanted(int a, int b) const {
    const auto parentOf = [&](int body) { return _model.joints[_jointAbove[body]].body0; };
    switch (_pairs) {
    case ALL:
        return true;
    case TAGGED:
        return std::ranges::any_of(_groups[a],
                                   [&](const std::string& group) { return _groups[b].contains(group); });
    case SIBLINGS:
        if (_jointAbove[a] >= 0 && _jointAbove[b] >= 0 && parentOf(a) == parentOf(b)) return true;
        break;
    case NEIGHBOURS:
        break;
    }
    const auto nextAbove = [&](int body) {
        do body = _jointAbove[body] < 0 ? -1 : parentOf(body);
        while (body >= 0 && _model.bodies[body].mesh.empty());
        return body;
    };
    const bool neighbours = nextAbove(b) == a;
    if (!_skeletonOf[b]) return neighbours;
    return _skeletonOf[a] == _skeletonOf[b] && !neighbours;
}

void ConstraintVisitor::addPairs() {
    const auto top = [&](int body) {
        while (_jointAbove[body] >= 0) body = _model.joints[_jointAbove[body]].body0;
        return body;
    };
    const tss::JointGraph graph(_model.joints);
    const int count = static_cast<int>(_model.bodies.size());
    for (int body = 0; body < count; ++body)
        if (_dropped[body] > 0 && !_quiet)
            OSG_WARN << "osgTSS: the pairs of " << _model.bodies[body].path
                     << " are left out: " << _dropped[body]
                     << " of its triangles have corners that are no numbers or no vertices" << std::endl;
    for (int b = 0; b < count; ++b)
        for (int a = 0; a < b; ++a)
            if (_dropped[a] == 0 && _dropped[b] == 0 && !_model.bodies[a].mesh.empty() &&
                !_model.bodies[b].mesh.empty() && top(a) == top(b) && wanted(a, b))
                addPair(a, b, *graph.chain(a, b)); // the only one: joints make a tree
    if (_tooManyDofs > 0 && !_quiet)
        OSG_NOTICE << "osgTSS: " << _tooManyDofs
                   << " pairs of bodies are left out: the joints between them have more "
                   << "than " << tss::maxDofs << " degrees of freedom" << std::endl;
}

const tss::SceneModel& ConstraintVisitor::getModel() {
    if (_finished) return _model;
    _finished = true;
    if (!_unlimited.empty() && !_quiet)
        OSG_WARN << "osgTSS: these slide without limits and are taken to stay where they are: " << _unlimited
                 << "; limits are given by the user value osgTSS:limits (\"transX:0:5\"), or by the option "
                 << "limits=NAME:transX:0:5 on loading" << std::endl;
    if (!_turning.empty() && !_quiet)
        OSG_NOTICE << "osgTSS: these turn all the way round about several axes, as no flag limits them, and "
                   << "take long to bake: " << _turning
                   << "; limits=written takes the limits written in them, "
                   << "limits=NAME:rotZ:-24:18 gives others" << std::endl;
    const auto tell = [&](const Some& some, const char* what, const char* expected) {
        if (some.count > 0 && !_model.joints.empty() && !_quiet)
            OSG_WARN << "osgTSS: " << what << " is part of no body, and tables do not know it: " << some.first
                     << (some.count > 1 ? " and " + std::to_string(some.count - 1) + " more" : "")
                     << "; expected " << expected << std::endl;
    };
    tell(_paging, "what is paged in later", "what joints can reach in the graph when it is extracted");
    tell(_shaded, "what shaders make of patches, triangles with adjacency and instances",
         "triangles of their own, where joints can reach them");
    _soft->finish(_model, [&](const std::string& what) {
        if (!_quiet) OSG_WARN << "osgTSS: " << what << std::endl;
    });
    addPairs();
    for (const tss::MuscleModel& muscle : _model.muscles)
        if (!muscle.activation.empty())
            _model.endTimeCode = std::max(_model.endTimeCode, muscle.activation.times.back());
    for (const tss::Joint& joint : _model.joints)
        for (const tss::TimeSamples& drive : joint.drives)
            if (!drive.empty()) _model.endTimeCode = std::max(_model.endTimeCode, drive.times.back());
    return _model;
}

} // namespace osgTSS
