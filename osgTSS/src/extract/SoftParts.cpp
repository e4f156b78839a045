#include "SoftParts.h"

#include "osgTSS/src/draw/BodyNodes.h"
#include "osgTSS/src/draw/DrawnVertices.h"

#include "bake/base/Error.h"
#include "bake/geometry/FibreLine.h"
#include "bake/geometry/MeshQuery.h"

#include <algorithm>
#include <map>

namespace osgTSS {

namespace {

/// A list of names that says nothing means all.
bool means(const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::ranges::find(names, name) != names.end();
}

/// Shares of bodies in an entry of a vertex array, their sum 1; none: nothing holds it.
using Held = std::map<int, double>;

std::vector<Held> heldBy(const osgAnimation::RigGeometry& rig, std::size_t count,
                         const std::function<int(const std::string&)>& bodyOf) {
    std::vector<Held> held(count);
    if (const auto* influences = rig.getInfluenceMap())
        for (const auto& [name, influence] : *influences) {
            const int bone = bodyOf(name);
            for (const auto& [vertex, weight] : influence)
                if (bone >= 0 && vertex < held.size() && weight > 0) held[vertex][bone] += weight;
        }
    for (Held& of : held) {
        double sum = 0;
        for (const auto& [bone, weight] : of) sum += weight;
        for (auto& [bone, weight] : of) weight /= sum;
    }
    return held;
}

/// By more than an exporter rounds.
bool differ(const Held& a, const Held& b) {
    constexpr double rounded = 0.05;
    const auto more = [](const Held& one, const Held& other) {
        return std::ranges::any_of(one, [&](const auto& share) {
            const auto found = other.find(share.first);
            return share.second > rounded + (found != other.end() ? found->second : 0);
        });
    };
    return more(a, b) || more(b, a);
}

/// The line that a muscle shortens along, found from the mesh of its surface: of a ring its closed line, else
/// from the end that is nearer to the bone that it rides on, which stays, to the other. Throws InputError for
/// a mesh without area.
std::vector<tss::Vec3> findFibre(const tss::SceneModel& scene, const tss::MuscleModel& muscle) {
    const tss::Body& body = scene.bodies.at(static_cast<std::size_t>(muscle.body));
    if (muscle.muscle.form == tss::MuscleForm::Ring) return tss::ringLine(body.mesh);
    std::vector<tss::Vec3> fibre = tss::fibreLine(body.mesh);
    if (muscle.bone < 0) return fibre;
    const tss::Body& bone = scene.bodies.at(static_cast<std::size_t>(muscle.bone));
    if (bone.mesh.empty()) return fibre;
    const tss::MeshQuery query(bone.mesh);
    const tss::Pose toBone = bone.placement.inverse(Eigen::Isometry) * body.placement;
    if (query.distance(toBone * fibre.back()) < query.distance(toBone * fibre.front()))
        std::ranges::reverse(fibre);
    return fibre;
}

} // namespace

osg::ref_ptr<osg::Geometry> restGeometryOf(osg::Drawable& drawable) {
    if (osg::Drawable* replaced = replacedBy(drawable)) return restGeometryOf(*replaced);
    if (auto* morph = dynamic_cast<osgAnimation::MorphGeometry*>(&drawable)) {
        osg::ref_ptr<osg::Geometry> rest = new osg::Geometry(*morph, osg::CopyOp::SHALLOW_COPY);
        rest->setUpdateCallback(nullptr);
        // The first morphing takes copies for its sources, and writes into the arrays from then on.
        const osg::Array* vertices = morph->getVertexSource();
        const osg::Array* normals = morph->getNormalSource();
        if (!vertices) vertices = morph->getVertexArray();
        if (!normals) normals = morph->getNormalArray();
        if (vertices) rest->setVertexArray(osg::clone(vertices, osg::CopyOp::DEEP_COPY_ALL));
        if (normals) rest->setNormalArray(osg::clone(normals, osg::CopyOp::DEEP_COPY_ALL));
        return rest;
    }
    auto* rig = dynamic_cast<osgAnimation::RigGeometry*>(&drawable);
    return rig && rig->getSourceGeometry() ? rig->getSourceGeometry() : drawable.asGeometry();
}

double reachOf(const osgAnimation::MorphGeometry& morph) {
    const osg::Array* own = morph.getVertexSource() ? morph.getVertexSource() : morph.getVertexArray();
    const auto* source = dynamic_cast<const osg::Vec3Array*>(own);
    std::vector<double> reach(source ? source->size() : 0, 0);
    const bool offsets = morph.getMethod() == osgAnimation::MorphGeometry::RELATIVE;
    for (const auto& target : morph.getMorphTargetList()) {
        const osg::Array* array = target.getGeometry() ? target.getGeometry()->getVertexArray() : nullptr;
        const auto* vertices = dynamic_cast<const osg::Vec3Array*>(array);
        for (std::size_t v = 0; vertices && v < std::min(reach.size(), vertices->size()); ++v)
            reach[v] += (offsets ? (*vertices)[v] : (*vertices)[v] - (*source)[v]).length();
    }
    return reach.empty() ? 0 : *std::ranges::max_element(reach);
}

tss::MuscleModel SoftParts::finished(const tss::SceneModel& scene, const TaggedMuscle& muscle) const {
    tss::MuscleModel model = muscle.model;
    model.muscle.surface = scene.bodies[model.body].mesh;
    model.muscle.fibre = findFibre(scene, model);
    if (muscle.to.empty()) return model;
    const auto bone = std::ranges::find_if(bones, [&](const Bone& b) { return b.name == muscle.to; });
    if (bone == bones.end())
        throw tss::InputError("no node that is tagged as a bone is called \"" + muscle.to + "\"");
    if (bone->body != model.bone) model.insertionBone = bone->body;
    return model;
}

/// Vertices that no bone holds move with what carries the mesh, as those do whose weights are all 0.
std::size_t SoftParts::setWeights(tss::SceneModel& scene, int body, osgAnimation::RigGeometry& rig,
                                  double scale, const std::function<int(const std::string&)>& bodyOf) {
    const auto skin =
        std::ranges::find_if(skins, [&](const Skin& found) { return found.model.body == body; });
    const tss::TriangleMesh& mesh = scene.bodies[body].mesh;
    const osg::ref_ptr<osg::Geometry> source = restGeometryOf(rig);
    const auto drawn = DrawnVertices::of(*source, mesh, scale, {});
    if (skin == skins.end() || !drawn) return 0;
    skin->rigged = true;
    const std::vector<Held> held = heldBy(rig, source->getVertexArray()->getNumElements(), bodyOf);
    const std::vector<bool> used = verticesIn(*source, true);
    std::vector<Held> holding;
    std::size_t torn = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        std::vector<Held> entries;
        for (const std::uint32_t entry : drawn->of(v))
            if (used[entry] && !held[entry].empty()) entries.push_back(held[entry]);
        if (entries.empty()) entries.push_back({{skin->carrier, 1}});
        holding.push_back(entries.front());
        torn += std::ranges::any_of(entries, [&](const Held& other) { return differ(other, entries[0]); });
    }
    std::map<int, std::uint32_t> places;
    tss::SkinWeights& weights = skin->model.weights;
    for (const Held& of : holding) {
        weights.influences = std::max(weights.influences, of.size());
        for (const auto& [bone, weight] : of) places.emplace(bone, 0u);
    }
    for (auto& [bone, place] : places) {
        place = static_cast<std::uint32_t>(weights.joints.size());
        weights.joints.push_back(bone);
        scene.bodies[bone].rigid = true; // a body, also where it has no mesh
    }
    for (std::size_t v = 0; v < holding.size(); ++v) {
        for (const auto& [bone, weight] : holding[v]) {
            weights.indices.push_back(places.at(bone));
            weights.weights.push_back(weight);
        }
        weights.indices.resize((v + 1) * weights.influences, 0);
        weights.weights.resize((v + 1) * weights.influences, 0);
    }
    return torn;
}

void SoftParts::setCarried(tss::SceneModel& scene, int body) {
    for (Skin& skin : skins) {
        if (skin.model.body != body) continue;
        const std::size_t count = scene.bodies[body].mesh.vertices.size();
        skin.model.weights.influences = 1;
        skin.model.weights.joints = {skin.carrier};
        skin.model.weights.indices.assign(count, 0);
        skin.model.weights.weights.assign(count, 1);
        scene.bodies[skin.carrier].rigid = true; // a body, also where it has no mesh
    }
}

/// The bodies that are tagged to be; without any tag all that have a mesh, but below a rigged mesh, which is
/// the shape of the bones itself, none.
std::vector<int> SoftParts::bonesOf(const tss::SceneModel& scene, const Skin& skin) const {
    std::vector<int> found;
    const auto soft = [&](int body) {
        return std::ranges::any_of(skins, [&](const Skin& other) { return other.model.body == body; }) ||
               std::ranges::any_of(muscles,
                                   [&](const TaggedMuscle& other) { return other.model.body == body; });
    };
    const auto add = [&](int body) {
        if (!soft(body) && !scene.bodies[body].mesh.empty() && std::ranges::find(found, body) == found.end())
            found.push_back(body);
    };
    for (const Bone& bone : bones)
        if (means(bone.skins, skin.name)) add(bone.body);
    if (bones.empty() && !skin.rigged)
        for (std::size_t body = 0; body < scene.bodies.size(); ++body) add(static_cast<int>(body));
    return found;
}

void SoftParts::finish(tss::SceneModel& scene, const std::function<void(const std::string&)>& tell) const {
    std::vector<std::pair<int, const TaggedMuscle*>> placed; ///< place in the scene
    for (const TaggedMuscle& muscle : muscles) {
        try {
            scene.muscles.push_back(finished(scene, muscle));
            placed.emplace_back(static_cast<int>(scene.muscles.size()) - 1, &muscle);
        } catch (const tss::InputError& error) {
            tell(muscle.model.path + ": it is no muscle: " + error.message);
        }
    }
    for (const Skin& skin : skins) {
        tss::SkinModel model = skin.model;
        model.path = scene.bodies[model.body].path;
        model.bones = bonesOf(scene, skin);
        for (const auto& [index, muscle] : placed)
            if (means(muscle->skins, skin.name)) model.muscles.push_back(index);
        if (model.bones.empty() && model.muscles.empty() && model.weights.joints.empty()) {
            tell(model.path + ": a skin with nothing below it stays as it is");
            continue;
        }
        scene.skins.push_back(model);
    }
}

} // namespace osgTSS
