#pragma once
#include "RigParts.h"

#include <osg/Transform>
#include <osg/Vec4>

#include <algorithm>
#include <optional>

namespace osgTSS {

/// What a visitor meets below one skeleton.
struct SkeletonMeshes {
    /// How a rigged mesh is drawn.
    struct Look {
        const osg::Drawable* drawable = nullptr;
        bool visible = true;
        std::optional<osg::Vec4> color{};
    };

    explicit SkeletonMeshes(const osg::Transform& skeleton) : _skeleton(skeleton) {}

    const osg::Node& skeleton() const { return _skeleton; }

    /// Takes note of where a bone's own coordinates are; other nodes are passed over.
    void addNode(const osg::Node& node, const InBody& place) {
        if (const auto* bone = dynamic_cast<const osgAnimation::Bone*>(&node)) _parts.addBone(*bone, place);
    }

    /// path: from the root to the mesh.
    void addRig(osgAnimation::RigGeometry& rig, const osg::NodePath& path, const InBody& place,
                const Look& look) {
        const auto at = std::find(path.begin(), path.end(), &_skeleton);
        _parts.addRig(rig, osg::computeLocalToWorld(osg::NodePath(at + 1, path.end())), place);
        _looks.push_back(look);
    }

    /// A mesh that is a skin, which is no part of any bone.
    struct Skin {
        osgAnimation::RigGeometry* rig = nullptr;
        int body = -1; ///< of the skin
        double scale = 1;
    };
    std::vector<Skin> skins;

    int bodyOf(const std::string& bone) const { return _parts.bodyOf(bone); }
    std::vector<RigParts::Part> parts() const { return _parts.parts(); }
    const Look& look(std::size_t rig) const { return _looks[rig]; }

private:
    const osg::Transform& _skeleton;
    RigParts _parts;
    std::vector<Look> _looks;
};

} // namespace osgTSS
