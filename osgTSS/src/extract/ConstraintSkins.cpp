#include "CollectTriangles.h"
#include "SkeletonMeshes.h"
#include "SoftParts.h"
#include "SoftTags.h"
#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/joints/AnimationChannels.h"

#include "bake/base/Error.h"

#include <osg/ValueObject>
#include <osgAnimation/MorphGeometry>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>

// Skins and muscles among the drawables that were found.
namespace osgTSS {

namespace {

/// A body of a shape that changes is drawn from float vertices.
osg::ref_ptr<osg::Geometry> shapeOf(osg::Drawable& drawable) {
    const osg::ref_ptr<osg::Geometry> geometry = restGeometryOf(drawable);
    if (dynamic_cast<osgAnimation::MorphGeometry*>(geometry.get()))
        throw tss::InputError("expected a rigged mesh without morph targets");
    if (!geometry || !dynamic_cast<osg::Vec3Array*>(geometry->getVertexArray()))
        throw tss::InputError("expected a geometry of float vertices (osg::Vec3Array)");
    return geometry;
}

} // namespace

/// A body of its own, in the geometry's own frame and lengths of the body that it hangs in.
void ConstraintVisitor::addSoftBody(osg::Drawable& drawable, const char* fallback) {
    const osg::ref_ptr<osg::Geometry> shape = shapeOf(drawable);
    const auto similarity = toSimilarity(_place.toBody);
    if (!similarity) throw tss::InputError("the transforms above it shear, or scale axes differently");
    PlaceInBody place = _place;
    place.scale *= similarity->scale;
    tss::Pose local = similarity->pose;
    local.translation() *= _place.scale;
    const tss::Pose above = _model.bodies[_place.body].placement;
    place.body = addBody(drawable, fallback, place.scale);
    tss::Body& body = _model.bodies[place.body];
    body.placement = above * local;
    _dropped[place.body] += collectTriangles(*shape, osg::Matrixd(), place.scale, body.mesh);
    if (body.mesh.empty()) throw tss::InputError("it has no triangles");
    addLook(drawable, place, true);
}

/// Whether the drawable is tagged as a skin or a muscle; one that cannot be served is part of no body.
bool ConstraintVisitor::addSoft(osg::Drawable& drawable) {
    const auto skin = tagWords(drawable, skinTag), muscle = tagWords(drawable, muscleTag);
    if (!skin && !muscle) return false;
    if (!_seen.insert(&drawable).second) return true; // the others follow the first
    const int carrier = _place.body;
    try {
        if (skin) {
            tss::SkinModel model = parseSkin(*skin);
            addSoftBody(drawable, "Skin");
            model.body = static_cast<int>(_model.bodies.size()) - 1;
            osg::Drawable* own = replacedBy(drawable) ? replacedBy(drawable) : &drawable;
            const auto* morph = dynamic_cast<osgAnimation::MorphGeometry*>(own);
            if (morph)
                model.travel = std::max(model.travel, reachOf(*morph) * std::abs(_bodyNodes.back().scale));
            _soft->skins.push_back({model, drawable.getName(), carrier});
            if (morph) _soft->setCarried(_model, model.body);
            auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(own);
            if (rig && _skeleton) _skeleton->skins.push_back({rig, model.body, _bodyNodes.back().scale});
            return true;
        }
        TaggedMuscle tagged = parseMuscle(*muscle);
        tss::MuscleModel& model = tagged.model;
        osg::Drawable* own = replacedBy(drawable);
        if (dynamic_cast<osgAnimation::MorphGeometry*>(own ? own : &drawable))
            throw tss::InputError("expected a shape of its own, and it has morph targets");
        if (dynamic_cast<osgAnimation::RigGeometry*>(own ? own : &drawable))
            throw tss::InputError(
                "expected a shape of its own, and bones turn it (osgAnimation::RigGeometry)");
        if (std::string words; (own ? *own : drawable).getUserValue(activationTag, words))
            model.activation = parseActivation(words, _model.timeCodesPerSecond);
        addSoftBody(drawable, "Muscle");
        model.body = static_cast<int>(_model.bodies.size()) - 1;
        model.bone = carrier;
        model.path = freePath(drawable.getName().empty() ? "Muscle" : drawable.getName());
        _soft->muscles.push_back(std::move(tagged));
    } catch (const tss::InputError& error) {
        warn(std::string(skin ? "it is no skin: " : "it is no muscle: ") + error.message);
    }
    return true;
}

} // namespace osgTSS
