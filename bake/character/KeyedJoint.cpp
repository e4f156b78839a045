#include "bake/character/KeyedJoint.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/AxisTurns.h"
#include "bake/motion/SmallSystems.h"
#include "bake/motion/WholeTurn.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tss {

namespace {

/// All turns as a mean one and small ones about it: R = mean frame E frame^-1, where the frame's axes are
/// those that E turns about, the most used first.
struct TurnFrame {
    Eigen::Quaterniond mean = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
    double most = 0;    ///< angle of any E
    double offAxis = 0; ///< of these the part that is not about the first axis
};

Vec3 turnVector(const Eigen::Quaterniond& q) {
    const Eigen::AngleAxisd turn(q.w() < 0 ? Eigen::Quaterniond(-q.coeffs()) : q);
    return turn.angle() * turn.axis();
}

TurnFrame turnFrame(const KeyedPoses& poses) {
    TurnFrame found;
    std::vector<Eigen::Quaterniond> turns;
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
    for (const KeyedPoses::Sample& sample : poses.samples) {
        turns.emplace_back(sample.pose.linear());
        moments += turns.back().coeffs() * turns.back().coeffs().transpose();
    }
    found.mean = Eigen::Quaterniond(Eigen::Vector4d(symmetricAxes(moments).col(3))).normalized();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Eigen::Quaterniond& q : turns) {
        q = found.mean.conjugate() * q;
        const Vec3 turn = turnVector(q);
        spread += turn * turn.transpose();
        found.most = std::max(found.most, turn.norm());
    }
    if (found.most <= poses.still) return found;
    const Eigen::Matrix3d axes = symmetricAxes(spread);
    found.frame.col(0) = axes.col(2);
    found.frame.col(1) = axes.col(1);
    found.frame.col(2) = found.frame.col(0).cross(found.frame.col(1));
    for (const Eigen::Quaterniond& q : turns) {
        const Vec3 turn = turnVector(q), first = found.frame.col(0);
        found.offAxis = std::max(found.offAxis, (turn - first * first.dot(turn)).norm());
    }
    return found;
}

/// Values of one DOF over all poses.
struct Track {
    int axis = 0;
    std::vector<double> values;
    double lower() const { return *std::ranges::min_element(values); }
    double upper() const { return *std::ranges::max_element(values); }
    double range() const { return upper() - lower(); }
};

/// addTurns() beyond a quarter turn of the middle angle: of the two ways to make a rotation the one that is
/// nearer to the one before.
void addAnyTurns(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes, bool first,
                 std::array<std::vector<double>, 3>& run) {
    constexpr double half = fullTurn / 2;
    const std::array<double, 3> one = turnsOf(rotation, axes),
                                other{one[0] + half, half - one[1], one[2] + half};
    std::array<double, 3> best{};
    double nearest = -1;
    for (const std::array<double, 3>& angles : {one, other}) {
        std::array<double, 3> near{};
        double away = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double before = first ? 0 : run[k].back();
            near[k] = nearestTurn(angles[k], before);
            away += std::abs(near[k] - before);
        }
        if (nearest < 0 || away < nearest) best = near, nearest = away;
    }
    for (std::size_t k = 0; k < 3; ++k) run[k].push_back(best[k]);
}

/// The turns E about the frame's axes in this order, without jumps from one sample of an animation to the
/// next; empty where the middle one goes too far.
std::vector<Track> turnTracks(const KeyedPoses& poses, const TurnFrame& frame,
                              const std::array<int, 3>& order, bool anyTurn) {
    const Eigen::Matrix3d from = (frame.mean.toRotationMatrix() * frame.frame).transpose();
    std::array<std::vector<double>, 3> angles;
    for (const KeyedPoses::Sample& sample : poses.samples) {
        const Eigen::Matrix3d turn = from * sample.pose.linear() * frame.frame;
        if (anyTurn)
            addAnyTurns(turn, order, sample.first, angles);
        else if (!addTurns(turn, order, sample.first, angles))
            return {};
    }
    std::vector<Track> tracks;
    for (std::size_t k = 0; k < 3; ++k) tracks.push_back({order[k], std::move(angles[k])});
    return tracks;
}

/// As few DOFs as serve, and of these the narrowest box; empty where no order of the axes serves.
std::vector<Track> narrowestTurns(const KeyedPoses& poses, const TurnFrame& frame, bool anyTurn) {
    std::vector<Track> best;
    double bestBox = 0;
    std::array<int, 3> order{0, 1, 2};
    if (frame.offAxis <= poses.still) {
        best = turnTracks(poses, frame, order, anyTurn);
        best.resize(1);
        return best;
    }
    do {
        std::vector<Track> tracks = turnTracks(poses, frame, order, anyTurn);
        if (tracks.empty()) continue;
        // About the last axis they may not turn at all; the outer two place what is inside of them.
        if (tracks[2].upper() <= poses.still && tracks[2].lower() >= -poses.still) tracks.pop_back();
        double box = 1;
        for (const Track& track : tracks) box *= track.range() + 0.01;
        if (best.empty() || tracks.size() < best.size() || (tracks.size() == best.size() && box < bestBox)) {
            best = std::move(tracks);
            bestBox = box;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

std::vector<Track> turnsOfBone(const KeyedPoses& poses, const TurnFrame& frame) {
    if (frame.most <= poses.still) return {};
    std::vector<Track> turns = narrowestTurns(poses, frame, false);
    if (turns.empty() && poses.anyTurn) turns = narrowestTurns(poses, frame, true);
    if (turns.empty()) throw InputError("its keys turn too far about several axes to be told apart");
    return turns;
}

/// The point of the parent and the point of the bone that stay on each other: t = at + R of.
struct Pivot {
    Vec3 at = Vec3::Zero(), of = Vec3::Zero();
    double off = 0; ///< by how much they do not
};

Pivot pivotOf(const KeyedPoses& poses, bool turns) {
    Pivot pivot;
    const auto measure = [&] {
        pivot.off = 0;
        for (const KeyedPoses::Sample& s : poses.samples)
            pivot.off =
                std::max(pivot.off, (s.pose.translation() - pivot.at - s.pose.linear() * pivot.of).norm());
    };
    pivot.at = poses.samples[poses.rest].pose.translation();
    measure();
    if (!turns || pivot.off == 0) return pivot;
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (const KeyedPoses::Sample& s : poses.samples) {
        Eigen::Matrix<double, 3, 6> row;
        row << Eigen::Matrix3d::Identity(), s.pose.linear();
        normal += row.transpose() * row;
        right += row.transpose() * s.pose.translation();
    }
    const Pivot still = pivot;
    // About one axis a point along it is free: the least one.
    const Eigen::Matrix<double, 6, 1> x = leastSolution(normal, right);
    pivot.at = x.head<3>();
    pivot.of = x.tail<3>();
    measure();
    return pivot.off < still.off / 100 ? pivot : still;
}

Dof dofOf(const std::string& name, DofKind kind, const Track& track, std::size_t rest) {
    Dof dof;
    dof.name = name;
    dof.kind = kind;
    dof.axis = Vec3::Unit(track.axis);
    dof.lower = track.lower() - keysSlack * track.range();
    dof.upper = track.upper() + keysSlack * track.range();
    dof.rest = track.values[rest];
    if (kind == DofKind::Rotation && dof.upper - dof.lower >= fullTurn) {
        setWholeTurn(dof);
        dof.rest = nearestTurn(dof.rest, 0);
    }
    return dof;
}

/// The slides along the frame's axes that are left where the pivot does not hold.
std::vector<Track> slidesOf(const KeyedPoses& poses, const Pivot& pivot, const Eigen::Matrix3d& frame) {
    std::vector<Track> slides;
    for (int axis = 0; axis < 3; ++axis) {
        Track track;
        track.axis = axis;
        for (const KeyedPoses::Sample& s : poses.samples) {
            const Vec3 at = s.pose.translation() - pivot.at - s.pose.linear() * pivot.of;
            track.values.push_back(frame.col(axis).dot(at));
        }
        if (track.range() > 1e-4 * poses.size) slides.push_back(std::move(track));
    }
    return slides;
}

} // namespace

KeyedJoint keyedJoint(const KeyedPoses& poses) {
    const TurnFrame frame = turnFrame(poses);
    const std::vector<Track> turns = turnsOfBone(poses, frame);
    const Pivot pivot = pivotOf(poses, !turns.empty());
    KeyedJoint found;
    Joint& joint = found.joint;
    joint.frame0.linear() = frame.mean.toRotationMatrix() * frame.frame;
    joint.frame0.translation() = pivot.at;
    joint.frame1.linear() = frame.frame;
    joint.frame1.translation() = -pivot.of;
    const std::vector<Track> slides = slidesOf(poses, pivot, joint.frame0.linear());
    for (const Track& slide : slides)
        joint.dofs.push_back(
            dofOf(std::string("slide.") + "xyz"[slide.axis], DofKind::Translation, slide, poses.rest));
    for (std::size_t k = 0; k < turns.size(); ++k)
        joint.dofs.push_back(dofOf(turns.size() == 1 ? "turn" : "turn" + std::to_string(k + 1),
                                   DofKind::Rotation, turns[k], poses.rest));
    joint.drives.resize(joint.dofs.size());
    for (const auto* tracks : {&slides, &turns})
        for (const Track& track : *tracks) found.values.push_back(track.values);
    for (std::size_t k = 0; k < poses.samples.size(); ++k) {
        std::vector<double> values;
        for (const std::vector<double>& track : found.values) values.push_back(track[k]);
        const Eigen::Matrix3d known = jointPose(joint, values).linear();
        found.off = std::max(found.off, (known - poses.samples[k].pose.linear()).cwiseAbs().maxCoeff());
    }
    if (joint.dofs.empty()) { // it stands as its first key has it
        joint.frame0 = poses.samples.front().pose;
        joint.frame1 = Pose::Identity();
    }
    return found;
}

} // namespace tss
