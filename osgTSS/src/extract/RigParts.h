#pragma once
#include "bake/model/SceneModel.h"

#include <osg/Matrixd>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>

#include <map>
#include <string>
#include <vector>

namespace osgTSS {

/// Where the coordinates of a node stand in a body.
struct InBody {
    int body = -1;
    osg::Matrixd toBody; ///< before the scale
    double scale = 1;
};

/// The rigged meshes of one skeleton, cut into the parts that its bones hold: a triangle is of the body whose
/// bones weigh most at its corners, in the place that it is bound in.
class RigParts {
public:
    void addBone(const osgAnimation::Bone& bone, const InBody& place) {
        _bones[bone.getName()] = {&bone, place};
    }

    /// The body that a bone is part of; -1: there is none of this name.
    int bodyOf(const std::string& bone) const {
        const auto found = _bones.find(bone);
        return found != _bones.end() ? found->second.place.body : -1;
    }

    /// toSkeleton: of the mesh. place: of the node that it hangs below, for vertices that no bone holds.
    void addRig(osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton, const InBody& place);

    /// What a body has of the meshes.
    struct Part {
        int body = -1;
        std::size_t rig = 0; ///< the first one, in the order that they were added
        tss::TriangleMesh mesh;
        std::size_t dropped = 0; ///< triangles left out since a corner is no finite point
    };

    /// The parts, by body. Meshes hang together where their vertices are at one place; where a part was cut
    /// off another its rim is closed by a fan, so that what was a solid is cut into solids.
    std::vector<Part> parts() const;

private:
    struct Held {
        const osgAnimation::Bone* bone = nullptr;
        InBody place;
    };
    struct Rig {
        osgAnimation::RigGeometry* rig = nullptr;
        osg::Matrixd toSkeleton;
        InBody place;
    };
    class Cutter;

    std::map<std::string, Held> _bones;
    std::vector<Rig> _rigs;
};

} // namespace osgTSS
