#include "SkeletonMeshes.h"

#include "CollectTriangles.h"
#include "osgTSS/src/NodePaths.h"

#include "bake/character/CutByWeights.h"

#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>

namespace osgTSS {

namespace {

osg::Geometry& sourceOf(osgAnimation::RigGeometry& rig) {
    return rig.getSourceGeometry() ? *rig.getSourceGeometry() : rig;
}

/// As columns, and then the scale.
Eigen::Affine3d toCore(const osg::Matrixd& matrix, double scale) {
    Eigen::Affine3d affine = Eigen::Affine3d::Identity();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) affine.matrix()(row, column) = scale * matrix(column, row);
    return affine;
}

} // namespace

void SkeletonMeshes::addRig(osgAnimation::RigGeometry& rig, const osg::NodePath& path,
                            const PlaceInBody& place) {
    const auto at = std::find(path.begin(), path.end(), &_skeleton);
    _rigs.push_back({&rig, alongPath(osg::NodePath(at + 1, path.end())), place});
}

tss::HeldMesh SkeletonMeshes::heldMesh(const Rig& rig) const {
    tss::HeldMesh mesh;
    const osg::Geometry& source = sourceOf(*rig.geometry);
    for (const osg::Vec3d& point : pointsOf(source))
        mesh.points.push_back(osgTSS::toCore(point * rig.toSkeleton));
    mesh.triangles = trianglesOf(source);
    mesh.mirrored = determinant(rig.toSkeleton) < 0;
    mesh.loose = static_cast<int>(_bones.size() + (&rig - _rigs.data()));
    mesh.weights.resize(mesh.points.size());
    if (const auto* map = rig.geometry->getInfluenceMap())
        for (const auto& [name, influence] : *map) {
            const auto bone = _bones.find(name);
            if (bone == _bones.end()) continue;
            const int holder = static_cast<int>(std::distance(_bones.begin(), bone));
            for (const auto& [vertex, weight] : influence)
                if (vertex < mesh.weights.size() && weight > 0)
                    mesh.weights[vertex].emplace_back(holder, weight);
        }
    return mesh;
}

std::map<int, SkeletonMeshes::Part> SkeletonMeshes::parts() const {
    std::vector<tss::Holder> holders;
    for (const auto& [name, held] : _bones)
        holders.push_back(
            {held.place.body,
             toCore(held.bone->getInvBindMatrixInSkeletonSpace() * held.place.toBody, held.place.scale)});
    std::vector<tss::HeldMesh> meshes;
    for (const Rig& rig : _rigs) { // a vertex that no bone holds moves with the node of its mesh
        const osg::Matrixd toBody = osg::Matrixd::inverse(rig.toSkeleton) * rig.place.toBody;
        holders.push_back({rig.place.body, toCore(toBody, rig.place.scale)});
        meshes.push_back(heldMesh(rig));
    }
    std::map<int, Part> parts;
    for (auto& [body, part] : tss::cutByWeights(holders, meshes))
        parts.emplace(body, Part{&_rigs[part.mesh], std::move(part.surface), part.dropped});
    return parts;
}

} // namespace osgTSS
