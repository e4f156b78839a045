#include "tests/adversary/judge/Surfaces.h"

#include "bake/compare/FclModel.h"
#include "bake/geometry/MeshAudit.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace adversary {

using tss::Corners;
using tss::MeshQuery;
using tss::SurfacePart;
using tss::Tri;
using tss::Vec3;
using tss::compare::fclPlace;

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

double area(const Corners& c) {
    return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
}

void append(TriangleMesh& mesh, const Corners& corners) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
}

/// Walks down to the parts: what none of them holds is other.
void divide(const Corners& corners, std::uint32_t cuts, const std::vector<std::uint32_t>& parts,
            SplitSurface& out) {
    const auto depth = std::bit_width(cuts);
    bool below = false;
    for (const std::uint32_t part : parts) {
        if (part == cuts) return append(out.exempt, corners);
        const auto deeper = std::bit_width(part);
        below = below || (deeper > depth && part >> (deeper - depth) == cuts);
    }
    if (!below) return append(out.other, corners);
    const auto both = tss::halves(corners);
    divide(both[0], 2 * cuts, parts, out);
    divide(both[1], 2 * cuts + 1, parts, out);
}

double areaOf(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        sum += area({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
    return sum;
}

std::unique_ptr<Model> modelOf(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return nullptr;
    auto model = std::make_unique<Model>();
    tss::compare::fillFclModel(*model, mesh);
    return model;
}

} // namespace

SplitSurface split(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts) {
    SplitSurface out;
    std::vector<std::vector<std::uint32_t>> of(mesh.triangles.size());
    for (const SurfacePart& part : parts) of.at(part.triangle).push_back(part.cuts);
    for (std::size_t t = 0; t < of.size(); ++t)
        divide({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}, 1, of[t], out);
    const double exempt = areaOf(out.exempt);
    if (exempt > 0) out.exemptShare = exempt / (exempt + areaOf(out.other));
    return out;
}

/// A part of a surface: triangles with area for FCL, those without apart.
struct Surfaces::Part {
    explicit Part(const TriangleMesh& mesh) : all(mesh) {
        TriangleMesh proper{mesh.vertices, {}}, thin{mesh.vertices, {}};
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            (tss::hasZeroArea(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) ? thin : proper)
                .triangles.push_back(mesh.triangles[t]);
        model = modelOf(proper);
        if (!thin.triangles.empty()) wires.emplace(thin);
    }
    bool empty() const { return all.triangleCount() == 0; }

    MeshQuery all;
    std::unique_ptr<Model> model;
    std::optional<MeshQuery> wires;
};

struct Surfaces::Side {
    Side(const TriangleMesh& mesh, const SplitSurface& parts)
        : whole(mesh), exempt(parts.exempt), other(parts.other) {
        TriangleMesh proper{mesh.vertices, {}};
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            if (!tss::hasZeroArea(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)))
                proper.triangles.push_back(mesh.triangles[t]);
        if (!proper.triangles.empty()) filled.emplace(tss::cleaned(proper));
    }
    Part whole, exempt, other;
    std::optional<tss::Solid> filled;
};

Surfaces::Surfaces(const TriangleMesh& a, const TriangleMesh& b, const tss::RestRegion& region) {
    const SplitSurface partsA = split(a, region.a), partsB = split(b, region.b);
    a_ = std::make_unique<Side>(a, partsA);
    b_ = std::make_unique<Side>(b, partsB);
    shareA_ = partsA.exemptShare;
    shareB_ = partsB.exemptShare;
    for (const TriangleMesh* mesh : {&a, &b})
        for (const Vec3& v : mesh->vertices) size_ = std::max(size_, v.norm());
}

Surfaces::~Surfaces() = default;

bool Surfaces::meet(const Part& a, const Part& b, const Pose& pose) const {
    if (a.empty() || b.empty()) return false;
    if (a.model && b.model) {
        const fcl::CollisionRequestd request(1, false);
        fcl::CollisionResultd result;
        if (fcl::collide(a.model.get(), fcl::Transform3d::Identity(), b.model.get(), fclPlace(pose), request,
                         result) > 0)
            return true;
    }
    return (a.wires && a.wires->distanceTo(b.all, pose, rounding(pose)) < rounding(pose) / 4) ||
           (b.wires && a.all.distanceTo(*b.wires, pose, rounding(pose)) < rounding(pose) / 4);
}

bool Surfaces::meet(const Pose& pose) const {
    if (a_->exempt.empty() || b_->exempt.empty()) return meet(a_->whole, b_->whole, pose);
    return meet(a_->other, b_->whole, pose) || meet(a_->exempt, b_->other, pose);
}

bool Surfaces::surelyMeet(const Pose& pose) const {
    return meet(pose) && clearance(pose) <= rounding(pose);
}

double Surfaces::clearance(const Pose& pose) const {
    if (a_->exempt.empty() || b_->exempt.empty()) return distance(pose);
    const double first = a_->other.all.distanceTo(b_->whole.all, pose);
    return std::min(first, a_->exempt.all.distanceTo(b_->other.all, pose, first));
}

double Surfaces::distance(const Pose& pose) const {
    return a_->whole.all.distanceTo(b_->whole.all, pose);
}

bool Surfaces::apart(const Pose& pose, double distance) const {
    return a_->whole.all.apart(b_->whole.all, pose, distance);
}

double Surfaces::distanceByFcl(const Pose& pose) const {
    if (a_->whole.wires || b_->whole.wires) return distance(pose);
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    return fcl::distance(a_->whole.model.get(), fcl::Transform3d::Identity(), b_->whole.model.get(),
                         fclPlace(pose), request, result);
}

bool Surfaces::fillingsNear(const Pose& pose, double within) const {
    if (!a_->filled || !b_->filled || !(a_->filled->open() || b_->filled->open())) return false;
    return !a_->filled->boundary().apart(b_->filled->boundary(), pose, within);
}

double Surfaces::rounding(const Pose& pose) const {
    return 32 * 0x1p-53 * (2 * size_ + pose.translation().norm());
}

} // namespace adversary
