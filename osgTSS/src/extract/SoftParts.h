#pragma once
#include "SoftTags.h"

#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>

#include <functional>
#include <string>
#include <vector>

namespace osgTSS {

/// The geometry that a drawable shows at rest: of a rigged mesh what it is made from, of a mesh of morph
/// targets itself without any, of a skin or muscle that install() put in its place the one that was there.
/// Null for a drawable that is no geometry.
osg::ref_ptr<osg::Geometry> restGeometryOf(osg::Drawable& drawable);

/// The farthest that a vertex may be moved by morph targets, all weights from 0 to 1, in its own lengths.
double reachOf(const osgAnimation::MorphGeometry& morph);

/// What a visitor meets of skins, of muscles and of the bones below them.
struct SoftParts {
    struct Skin {
        tss::SkinModel model; ///< its body is in the scene, with its mesh
        std::string name;
        int carrier = -1; ///< the body that its node is part of
        bool rigged = false;
    };
    /// A body that skins lie on, by the node that was tagged.
    struct Bone {
        int body = -1;
        std::string name;
        std::vector<std::string> skins; ///< their names, none: all
    };
    std::vector<Skin> skins;
    std::vector<TaggedMuscle>
        muscles; ///< their bodies likewise; each rides on the body that its node is part of
    std::vector<Bone> bones;

    /// The weights that a rigged mesh has, for its skin. bodyOf: of a bone by its name, -1: not known.
    /// Returns at how many places there are vertices that different bones hold.
    std::size_t setWeights(tss::SceneModel& scene, int body, osgAnimation::RigGeometry& rig, double scale,
                           const std::function<int(const std::string&)>& bodyOf);

    /// The same for a mesh whose shape something else makes: bones do not turn it, it moves with its carrier
    /// alone.
    void setCarried(tss::SceneModel& scene, int body);

    /// Puts them into the model: muscles get their fibres, skins what lies below them. tell: hears what
    /// cannot be served, with the path of its prim.
    void finish(tss::SceneModel& scene, const std::function<void(const std::string&)>& tell) const;

private:
    tss::MuscleModel finished(const tss::SceneModel& scene, const TaggedMuscle& muscle) const;
    std::vector<int> bonesOf(const tss::SceneModel& scene, const Skin& skin) const;
};

} // namespace osgTSS
