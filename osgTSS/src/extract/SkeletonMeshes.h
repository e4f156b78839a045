#pragma once
#include "bake/character/CutByWeights.h"

#include <osg/Transform>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgTSS/ConstraintVisitor>

#include <map>
#include <string>
#include <vector>

namespace osgTSS {

/// What a visitor meets below one skeleton: the rigged meshes, cut into the parts that its bones hold. A
/// triangle is of the body whose bones weigh most at its corners, in the place that it is bound in.
class SkeletonMeshes {
public:
    explicit SkeletonMeshes(const osg::Transform& skeleton) : _skeleton(skeleton) {}

    const osg::Node& skeleton() const { return _skeleton; }

    /// Takes note of where a bone's own coordinates are; other nodes are passed over.
    void addNode(const osg::Node& node, const PlaceInBody& place) {
        if (const auto* bone = dynamic_cast<const osgAnimation::Bone*>(&node))
            _bones[bone->getName()] = {bone, place};
    }

    /// The body that a bone is part of; -1: there is none of this name.
    int bodyOf(const std::string& bone) const {
        const auto found = _bones.find(bone);
        return found != _bones.end() ? found->second.place.body : -1;
    }

    /// path: from the root to the mesh. place: of the node that it hangs below, for vertices that no bone
    /// holds.
    void addRig(osgAnimation::RigGeometry& rig, const osg::NodePath& path, const PlaceInBody& place);

    /// A mesh that is a skin, which is no part of any bone.
    struct Skin {
        osgAnimation::RigGeometry* rig = nullptr;
        int body = -1; ///< of the skin
        double scale = 1;
    };
    std::vector<Skin> skins;

    struct Rig {
        osgAnimation::RigGeometry* geometry = nullptr;
        osg::Matrixd toSkeleton;
        PlaceInBody place;
    };
    /// What a body has of the meshes.
    struct Part {
        const Rig* rig = nullptr; ///< the first one, in the order that they were added
        tss::TriangleMesh mesh;
        std::size_t dropped = 0; ///< triangles left out since a corner is no finite point
    };

    /// The parts, by body (tss::cutByWeights()).
    std::map<int, Part> parts() const;

private:
    struct Held {
        const osgAnimation::Bone* bone = nullptr;
        PlaceInBody place;
    };
    tss::HeldMesh heldMesh(const Rig& rig) const;

    const osg::Transform& _skeleton;
    std::map<std::string, Held> _bones;
    std::vector<Rig> _rigs;
};

} // namespace osgTSS
