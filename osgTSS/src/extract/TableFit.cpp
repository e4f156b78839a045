#include "TableFit.h"
#include "osgTSS/src/draw/NearPoints.h"
#include "osgTSS/src/joints/JointNode.h"

#include "bake/model/SourceHash.h"
#include "bake/motion/WholeTurn.h"
#include "bake/table/TablePairs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace osgTSS {

namespace {

/// A share of the size of what is compared: float coordinates that were moved once or twice agree to it.
constexpr double same = 1e-5;

/// Area, and the area's first and second moments about a point: what does not depend on how it is cut.
struct Moments {
    double area = 0;
    tss::Vec3 first = tss::Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

    Moments(const tss::TriangleMesh& mesh, const tss::Vec3& about) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const tss::Vec3 a = mesh.corner(t, 0) - about, b = mesh.corner(t, 1) - about,
                            c = mesh.corner(t, 2) - about, sum = a + b + c;
            const double of = 0.5 * (b - a).cross(c - a).norm();
            area += of;
            first += of / 3 * sum;
            second +=
                of / 12 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
        }
    }
};

bool sameSurface(const tss::TriangleMesh& a, const tss::TriangleMesh& b) {
    if (a.empty() || b.empty()) return a.empty() == b.empty();
    const Eigen::AlignedBox3d box = tss::bounds(a);
    const double size = box.diagonal().norm() + box.center().norm() * 1e-2;
    const double length = box.diagonal().norm();
    const Moments of(a, box.center()), other(b, box.center());
    const double slack = 10 * same * of.area;
    if (std::abs(of.area - other.area) > slack || (of.first - other.first).norm() > slack * length ||
        (of.second - other.second).norm() > slack * length * length)
        return false;
    const NearPoints inA(a.vertices, same * size), inB(b.vertices, same * size);
    for (const tss::Vec3& vertex : a.vertices)
        if (inB.nearest(vertex) < 0) return false;
    for (const tss::Vec3& vertex : b.vertices)
        if (inA.nearest(vertex) < 0) return false;
    return true;
}

bool samePose(const tss::Pose& a, const tss::Pose& b, double size) {
    return (a.linear() - b.linear()).cwiseAbs().maxCoeff() <= 10 * same &&
           (a.translation() - b.translation()).norm() <= 10 * same * size;
}

bool sameDof(const tss::Dof& a, const tss::Dof& b, double size) {
    if (a.kind != b.kind || a.path.size() != b.path.size() || (a.axis - b.axis).norm() > same * b.axis.norm())
        return false;
    // A point on an axis is as good as any other on it.
    const tss::Vec3 between = a.origin - b.origin;
    if (a.kind == tss::DofKind::Rotation && between.cross(b.axis).norm() > 10 * same * size) return false;
    if (a.kind == tss::DofKind::Path && !samePose(a.frame, b.frame, size)) return false;
    for (std::size_t k = 0; k < a.path.size(); ++k)
        if (std::abs(a.path[k].value - b.path[k].value) > same * (b.upper - b.lower) ||
            (a.path[k].translation - b.path[k].translation).norm() > 10 * same * size ||
            a.path[k].rotation.angularDistance(b.path[k].rotation) > 10 * same)
            return false;
    return true;
}

/// How far a corner of B's box is from where the motion of the table has it, at the worst of some poses.
double worstOff(const tss::Motion& is, const tss::Motion& was, const tss::TriangleMesh& meshB) {
    const Eigen::AlignedBox3d box = tss::bounds(meshB);
    double worst = 0;
    for (const std::vector<double>& q : tss::latticePoses(was, 64)) {
        const tss::Pose now = tss::pose(is, q), then = tss::pose(was, q);
        for (int corner = 0; corner < 8; ++corner) {
            const tss::Vec3 x = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
            worst = std::max(worst, (now * x - then * x).norm());
        }
    }
    return worst;
}

/// What a table or a proof has to spare, scene units; nothing where it is not known.
std::optional<double> spareOf(const tss::Pair& pair) {
    if (pair.proof) return 0.5 * pair.proof->clearance;
    if (pair.table && pair.table->boundEarly) return 0.1 * *pair.table->boundEarly;
    return std::nullopt;
}

std::string wider(const tss::Dof& now, const tss::Dof& baked) {
    const double slack = nodeRounding(baked);
    if (tss::wholeTurn(baked) || (now.lower >= baked.lower - slack && now.upper <= baked.upper + slack))
        return "";
    return "the limits of " + now.name + " are wider than those that its table was made for";
}

} // namespace

std::string whyWider(const tss::Joint& now, const tss::Joint& baked) {
    if (now.dofs.size() != baked.dofs.size()) return "the joint has other degrees of freedom";
    for (std::size_t k = 0; k < now.dofs.size(); ++k) {
        if (now.dofs[k].kind != baked.dofs[k].kind) return "the joint has other degrees of freedom";
        if (const std::string why = wider(now.dofs[k], baked.dofs[k]); !why.empty()) return why;
    }
    return "";
}

std::string whyUnfit(const tss::SceneModel& found, const std::vector<int>& joints,
                     const tss::SceneModel& model, const tss::Pair& pair) {
    tss::Pair now;
    now.joints = joints;
    now.settings = pair.settings;
    const auto endOf = [&](std::size_t k, int body) {
        const tss::Joint& joint = found.joints[joints[k]];
        return model.joints[pair.joints[k]].body0 == body ? joint.body0 : joint.body1;
    };
    now.bodyA = endOf(0, pair.bodyA);
    now.bodyB = endOf(joints.size() - 1, pair.bodyB);
    int at = now.bodyA; // the same chain?
    for (int index : joints) {
        const tss::Joint& joint = found.joints[index];
        if (at != joint.body0 && at != joint.body1) return "its joints do not hang on each other any more";
        at = at == joint.body0 ? joint.body1 : joint.body0;
    }
    if (at != now.bodyB) return "its joints do not hang on each other any more";
    const std::string stored = pair.sourceHash.empty() ? tss::sourceHash(model, pair) : pair.sourceHash;
    if (tss::sourceHash(found, now) == stored) return "";

    const tss::Motion is = tss::pairMotion(found, now), was = tss::pairMotion(model, pair);
    if (is.dofs.size() != was.dofs.size()) return "the joint has other degrees of freedom";
    const tss::TriangleMesh &meshA = model.bodies[pair.bodyA].mesh, &meshB = model.bodies[pair.bodyB].mesh;
    if (!sameSurface(found.bodies[now.bodyA].mesh, meshA))
        return "the geometry of " + model.bodies[pair.bodyA].path + " is not what its table was made from";
    if (!sameSurface(found.bodies[now.bodyB].mesh, meshB))
        return "the geometry of " + model.bodies[pair.bodyB].path + " is not what its table was made from";
    const double size = meshA.empty() ? 1 : tss::diagonal(meshA);
    for (std::size_t k = 0; k < is.dofs.size(); ++k) {
        if (!sameDof(is.dofs[k], was.dofs[k], size)) return "the axes of its joint are others";
        if (const std::string why = wider(is.dofs[k], was.dofs[k]); !why.empty()) return why;
    }
    if (!samePose(is.base, was.base, size)) return "its joint stands elsewhere on its bodies";
    const std::optional<double> spare = spareOf(pair);
    if (!spare || meshB.empty()) return "";
    const double off = worstOff(is, was, meshB);
    if (off <= *spare) return "";
    std::ostringstream text;
    text << "its bodies are up to " << off
         << " scene units from where they were when it was baked, more than " << *spare
         << ", which it has to spare";
    return text.str();
}

} // namespace osgTSS
