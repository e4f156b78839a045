#pragma once
#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/robot/MeshFiles.h"
#include "bake/robot/RobotScene.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <map>

namespace tss {

/// Says what differs in a file, the first few of it, and whether anything does.
class Differences {
public:
    explicit Differences(std::string file) : file_(std::move(file)) {}

    void add(const std::string& text) {
        constexpr int most = 8;
        if (++count_ <= most) fmt::print("{}: {}\n", file_, text);
    }
    bool any() const { return count_ > 0; }

private:
    std::string file_;
    int count_ = 0;
};

/// What is read here of a file, and the scene that is made of it; or why it is refused.
struct Own {
    Robot robot;
    RobotScene made;
    std::string refusal;
};

inline Own readOwn(const std::function<Robot()>& read, const std::string& file) {
    Own own;
    try {
        own.robot = read();
        own.made = sceneOf(own.robot, {}, meshesOf(file, {}));
    } catch (const InputError& error) {
        own.refusal = error.what();
    }
    return own;
}

/// The joint that holds each link, -1 where none does.
inline std::vector<int> holders(const Robot& robot) {
    std::vector<int> above(robot.links.size(), -1);
    for (std::size_t j = 0; j < robot.joints.size(); ++j) above[robot.joints[j].child] = static_cast<int>(j);
    return above;
}

/// What a link hangs on in the end: a link that no joint holds, or -1, the world.
inline int rootOf(const Robot& robot, const std::vector<int>& above, int link) {
    while (link >= 0 && above[link] >= 0) link = robot.joints[above[link]].parent;
    return link;
}

/// The values of the robot's joints, one vector a joint, in the order of the scene's: a parent's first.
inline std::vector<double> sceneValues(const Robot& robot, const std::vector<std::vector<double>>& values) {
    std::vector<double> all;
    std::vector<bool> done(robot.joints.size()), placed(robot.links.size(), true);
    for (const RobotJoint& joint : robot.joints) placed[joint.child] = false;
    for (bool again = true; again;) {
        again = false;
        for (std::size_t j = 0; j < robot.joints.size(); ++j) {
            const RobotJoint& joint = robot.joints[j];
            if (done[j] || (joint.parent >= 0 && !placed[joint.parent])) continue;
            all.insert(all.end(), values[j].begin(), values[j].end());
            again = done[j] = placed[joint.child] = true;
        }
    }
    return all;
}

/// Whether a note says of a link that a shape of it cannot be had.
inline bool isLacking(const RobotScene& made, const std::string& link) {
    for (const std::string& note : made.notes)
        if (note.starts_with("left out: ") && note.find("(<link " + link + ">)") != note.npos) return true;
    return false;
}

/// Points among which those near a place are found.
class Points {
public:
    explicit Points(std::vector<Vec3> points) : points_(std::move(points)) {
        std::ranges::sort(points_, {}, [](const Vec3& p) { return p.x(); });
    }

    bool hasNear(const Vec3& place, double most) const {
        const auto x = [](const Vec3& p) { return p.x(); };
        for (auto p = std::ranges::lower_bound(points_, place.x() - most, {}, x);
             p != points_.end() && p->x() <= place.x() + most; ++p)
            if ((*p - place).norm() <= most) return true;
        return false;
    }

private:
    std::vector<Vec3> points_;
};

/// A shape as the other program has it.
struct Solid {
    RobotShape::Kind kind = RobotShape::Kind::Mesh;
    Vec3 size = Vec3::Zero(); ///< half lengths, radii first
    Pose place = Pose::Identity();
    std::vector<Vec3> corners; ///< of a mesh, in the shape's frame
    double rounding = 0;       ///< by how much those may be off

    bool isRound() const { return kind != RobotShape::Kind::Mesh && kind != RobotShape::Kind::Box; }
};

/// Points that the surface comes near to, in the shape's frame.
inline std::vector<Vec3> outline(const Solid& solid) {
    using Kind = RobotShape::Kind;
    const Vec3& s = solid.size;
    std::vector<Vec3> points = solid.corners;
    if (solid.kind == Kind::Box)
        for (int k = 0; k < 8; ++k)
            points.emplace_back(k & 1 ? s[0] : -s[0], k & 2 ? s[1] : -s[1], k & 4 ? s[2] : -s[2]);
    if (!solid.isRound()) return points;
    const double across = solid.kind == Kind::Ellipsoid ? s[1] : s[0];
    const double half = solid.kind == Kind::Capsule || solid.kind == Kind::Cylinder ? s[1] : 0;
    const double tip = solid.kind == Kind::Cylinder    ? half
                       : solid.kind == Kind::Ellipsoid ? s[2]
                                                       : s[0] + half;
    for (const double side : {-1.0, 1.0}) {
        for (const double height : {half, -half})
            points.emplace_back(side * s[0], 0, height), points.emplace_back(0, side * across, height);
        points.emplace_back(0, 0, side * tip);
    }
    return points;
}

/// How far outside of a round shape a point of its frame lies, by its radius; of a cylinder, one of its ends.
inline double outside(const Solid& solid, const Vec3& p) {
    using Kind = RobotShape::Kind;
    const Vec3& s = solid.size;
    const double around = std::hypot(p.x(), p.y());
    if (solid.kind == Kind::Sphere) return p.norm() / s[0] - 1;
    if (solid.kind == Kind::Capsule)
        return std::hypot(around, std::max(0.0, std::abs(p.z()) - s[1])) / s[0] - 1;
    if (solid.kind == Kind::Cylinder) {
        if (std::abs(std::abs(p.z()) - s[1]) > 1e-6) return -1;
        return around < 1e-6 ? 0 : around / s[0] - 1;
    }
    return p.cwiseQuotient(s).norm() - 1;
}

/// Where a mesh is another than all these shapes; empty where it is none. Round ones it encloses closely.
inline std::string shapeDifference(const TriangleMesh& mesh, const std::vector<Solid>& solids) {
    constexpr double close = 1e-6, most = 0.0061;
    const Points own(mesh.vertices);
    std::vector<Vec3> exact;
    double rounding = close;
    for (const Solid& solid : solids) {
        rounding = std::max(rounding, solid.rounding);
        for (const Vec3& at : outline(solid)) {
            const Vec3 p = solid.place * at;
            if (!solid.isRound()) exact.push_back(p);
            // The corners of a round one may lie elsewhere around.
            const double slack = solid.isRound() ? 0.07 * at.norm() : solid.rounding + close * (1 + p.norm());
            if (!own.hasNear(p, slack))
                return fmt::format("its shape does not come to {} {} {}, theirs does", p.x(), p.y(), p.z());
        }
    }
    const Points theirs(std::move(exact));
    std::vector<bool> used(mesh.vertices.size());
    for (const Tri& t : mesh.triangles) used[t[0]] = used[t[1]] = used[t[2]] = true;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vec3& p = mesh.vertices[v];
        const bool known = !used[v] || theirs.hasNear(p, rounding + close * (1 + p.norm())) ||
                           std::ranges::any_of(solids, [&](const Solid& solid) {
                               if (!solid.isRound()) return false;
                               const double out = outside(solid, solid.place.inverse(Eigen::Isometry) * p);
                               return out > -close && out < most;
                           });
        if (!known) return fmt::format("its shape comes to {} {} {}, theirs does not", p.x(), p.y(), p.z());
    }
    return "";
}

/// How often each text was met.
using Tally = std::map<std::string, int>;

/// A refusal without the file and the line.
inline std::string reasonOf(const std::string& refusal) {
    const auto place = refusal.find("): "), file = refusal.find(": ");
    return refusal.substr(place != refusal.npos ? place + 3 : file != refusal.npos ? file + 2 : 0);
}

inline void printTally(const std::string& title, const Tally& tally) {
    for (const auto& [text, count] : tally) fmt::print("{}: {} times: {}\n", title, count, text);
}

} // namespace tss
