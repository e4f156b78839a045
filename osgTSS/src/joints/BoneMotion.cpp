#include "BoneMotion.h"

#include "AxisDofs.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/SmallSystems.h"
#include "bake/motion/WholeTurn.h"

#include <osg/ValueObject>
#include <osgTSS/Convert>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace osgTSS {

namespace {

struct Sample {
    tss::Pose pose;
    bool first; ///< of a run: the angles before are another animation's
};

/// Poses of the bone against its parent, and the scale that it has at all of them.
struct Samples {
    std::vector<Sample> all;
    double still = 0;  ///< turns of less are none
    bool skin = false; ///< that of its skeleton follows it
    double scale = 0;
    double off = 0;
    double size = 0;      ///< length that the matrices' digits are of
    std::size_t rest = 0; ///< which of them

    void add(const osg::Matrixd& matrix, bool first) {
        constexpr double most = 0.05;
        const auto similarity = toSimilarity(matrix, std::max(still, most));
        if (!similarity) throw tss::InputError("its keys shear it, or scale its axes differently");
        if (scale == 0) scale = similarity->scale;
        if (std::abs(similarity->scale - scale) > std::max(still, similarity->off) * std::abs(scale))
            throw tss::InputError(std::string("its keys change its size") +
                                  (skin ? ", which its skin does not follow" : ""));
        off = std::max(off, similarity->off);
        size = std::max(size, similarity->pose.translation().norm());
        all.push_back({similarity->pose, first});
    }
};

Samples samplesOf(osgAnimation::Bone& bone, const AnimationChannels& channels) {
    Samples samples;
    samples.still = boneStill(bone);
    samples.skin = wearsSkin(bone);
    for (const auto& run : boneRuns(bone, channels))
        for (std::size_t k = 0; k < run.size(); ++k) samples.add(run[k], k == 0);
    if (samples.off > samples.still) {
        std::ostringstream text;
        text.precision(2);
        text << "between its keys, which are matrices, OpenSceneGraph scales its axes differently, by up to "
             << 100 * samples.off << " %: still=" << std::ceil(20 * samples.off * 360 / tss::fullTurn) / 20
             << " in -O takes that for none, more keys make it less";
        throw tss::InputError(text.str());
    }
    const std::optional<osg::Matrixd> bound = boneBound(bone);
    // A bone that no key moves may stand otherwise than it is bound, which only a skin looks at.
    const bool keyed = !samples.all.empty();
    if (!keyed) samples.add(boneNow(bone), true);
    if (bound && (keyed || samples.skin) && toSimilarity(*bound)) {
        samples.rest = samples.all.size();
        samples.add(*bound, true);
        samples.size = std::max(samples.size, bone.getInvBindMatrixInSkeletonSpace().getTrans().length());
    }
    return samples;
}

/// All turns as a mean one and small ones about it: R = mean frame E frame^-1, where the frame's axes are
/// those that E turns about, the most used first.
struct TurnFrame {
    Eigen::Quaterniond mean = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
    double most = 0;    ///< angle of any E
    double offAxis = 0; ///< of these the part that is not about the first axis
};

tss::Vec3 turnVector(const Eigen::Quaterniond& q) {
    const Eigen::AngleAxisd turn(q.w() < 0 ? Eigen::Quaterniond(-q.coeffs()) : q);
    return turn.angle() * turn.axis();
}

TurnFrame turnFrame(const Samples& samples) {
    TurnFrame found;
    std::vector<Eigen::Quaterniond> turns;
    Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
    for (const Sample& sample : samples.all) {
        turns.emplace_back(sample.pose.linear());
        moments += turns.back().coeffs() * turns.back().coeffs().transpose();
    }
    found.mean = Eigen::Quaterniond(Eigen::Vector4d(tss::symmetricAxes(moments).col(3))).normalized();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Eigen::Quaterniond& q : turns) {
        q = found.mean.conjugate() * q;
        const tss::Vec3 turn = turnVector(q);
        spread += turn * turn.transpose();
        found.most = std::max(found.most, turn.norm());
    }
    if (found.most <= samples.still) return found;
    const Eigen::Matrix3d axes = tss::symmetricAxes(spread);
    found.frame.col(0) = axes.col(2);
    found.frame.col(1) = axes.col(1);
    found.frame.col(2) = found.frame.col(0).cross(found.frame.col(1));
    for (const Eigen::Quaterniond& q : turns) {
        const tss::Vec3 turn = turnVector(q), first = found.frame.col(0);
        found.offAxis = std::max(found.offAxis, (turn - first * first.dot(turn)).norm());
    }
    return found;
}

/// Values of one DOF over all samples.
struct Track {
    int axis = 0;
    std::vector<double> values;
    double lower() const { return *std::ranges::min_element(values); }
    double upper() const { return *std::ranges::max_element(values); }
    double range() const { return upper() - lower(); }
};

/// The turns E about the frame's axes in this order, without jumps from one sample of an animation to the
/// next; empty where the middle one goes too far.
std::vector<Track> turnTracks(const Samples& samples, const TurnFrame& frame,
                              const std::array<int, 3>& order) {
    const Eigen::Matrix3d from = (frame.mean.toRotationMatrix() * frame.frame).transpose();
    std::array<std::vector<double>, 3> angles;
    for (const Sample& sample : samples.all)
        if (!addTurns(from * sample.pose.linear() * frame.frame, order, sample.first, angles)) return {};
    std::vector<Track> tracks;
    for (std::size_t k = 0; k < 3; ++k) tracks.push_back({order[k], std::move(angles[k])});
    return tracks;
}

/// As few DOFs as serve, and of these the narrowest box.
std::vector<Track> turnsOfBone(const Samples& samples, const TurnFrame& frame) {
    if (frame.most <= samples.still) return {};
    std::vector<Track> best;
    double bestBox = 0;
    std::array<int, 3> order{0, 1, 2};
    if (frame.offAxis <= samples.still) {
        best = turnTracks(samples, frame, order);
        best.resize(1);
        return best;
    }
    do {
        std::vector<Track> tracks = turnTracks(samples, frame, order);
        if (tracks.empty()) continue;
        // About the last axis they may not turn at all; the outer two place what is inside of them.
        if (tracks[2].upper() <= samples.still && tracks[2].lower() >= -samples.still) tracks.pop_back();
        double box = 1;
        for (const Track& track : tracks) box *= track.range() + 0.01;
        if (best.empty() || tracks.size() < best.size() || (tracks.size() == best.size() && box < bestBox)) {
            best = std::move(tracks);
            bestBox = box;
        }
    } while (std::next_permutation(order.begin(), order.end()));
    if (best.empty()) throw tss::InputError("its keys turn too far about several axes to be told apart");
    return best;
}

/// The point of the parent and the point of the bone that stay on each other: t = at + R of.
struct Pivot {
    tss::Vec3 at = tss::Vec3::Zero(), of = tss::Vec3::Zero();
    double off = 0; ///< by how much they do not
};

Pivot pivotOf(const Samples& samples, bool turns) {
    Pivot pivot;
    const auto measure = [&] {
        pivot.off = 0;
        for (const Sample& s : samples.all)
            pivot.off =
                std::max(pivot.off, (s.pose.translation() - pivot.at - s.pose.linear() * pivot.of).norm());
    };
    pivot.at = samples.all[samples.rest].pose.translation();
    measure();
    if (!turns || pivot.off == 0) return pivot;
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (const Sample& s : samples.all) {
        Eigen::Matrix<double, 3, 6> row;
        row << Eigen::Matrix3d::Identity(), s.pose.linear();
        normal += row.transpose() * row;
        right += row.transpose() * s.pose.translation();
    }
    const Pivot still = pivot;
    // About one axis a point along it is free: the least one.
    const Eigen::Matrix<double, 6, 1> x = tss::leastSolution(normal, right);
    pivot.at = x.head<3>();
    pivot.of = x.tail<3>();
    measure();
    return pivot.off < still.off / 100 ? pivot : still;
}

tss::Dof dofOf(const std::string& name, tss::DofKind kind, const Track& track, std::size_t rest) {
    tss::Dof dof;
    dof.name = name;
    dof.kind = kind;
    dof.axis = tss::Vec3::Unit(track.axis);
    dof.lower = track.lower() - boneSlack * track.range();
    dof.upper = track.upper() + boneSlack * track.range();
    dof.rest = track.values[rest];
    if (kind == tss::DofKind::Rotation && dof.upper - dof.lower >= tss::fullTurn) {
        tss::setWholeTurn(dof);
        dof.rest = tss::nearestTurn(dof.rest, 0);
    }
    return dof;
}

/// The slides along the frame's axes that are left where the pivot does not hold.
std::vector<Track> slidesOf(const Samples& samples, const Pivot& pivot, const Eigen::Matrix3d& frame) {
    std::vector<Track> slides;
    for (int axis = 0; axis < 3; ++axis) {
        Track track;
        track.axis = axis;
        for (const Sample& s : samples.all) {
            const tss::Vec3 at = s.pose.translation() - pivot.at - s.pose.linear() * pivot.of;
            track.values.push_back(frame.col(axis).dot(at));
        }
        if (track.range() > 1e-4 * samples.size) slides.push_back(std::move(track));
    }
    return slides;
}

} // namespace

double boneStill(const osg::Node& bone) {
    constexpr double rounded = 1e-3;
    double degrees = 0;
    return bone.getUserValue("osgTSS:still", degrees) && degrees > 0
               ? std::max(rounded, degrees * tss::fullTurn / 360)
               : rounded;
}

FoundJoints boneMotion(osgAnimation::Bone& bone, const AnimationChannels& channels) {
    const Samples samples = samplesOf(bone, channels);
    const TurnFrame frame = turnFrame(samples);
    const std::vector<Track> turns = turnsOfBone(samples, frame);
    const Pivot pivot = pivotOf(samples, !turns.empty());
    FoundJoints found;
    found.scale = samples.scale;
    found.off = samples.off;
    tss::Joint joint;
    joint.frame0.linear() = frame.mean.toRotationMatrix() * frame.frame;
    joint.frame0.translation() = pivot.at;
    joint.frame1.linear() = frame.frame;
    joint.frame1.translation() = -pivot.of;
    const std::vector<Track> slides = slidesOf(samples, pivot, joint.frame0.linear());
    for (const Track& slide : slides)
        joint.dofs.push_back(
            dofOf(std::string("slide.") + "xyz"[slide.axis], tss::DofKind::Translation, slide, samples.rest));
    for (std::size_t k = 0; k < turns.size(); ++k)
        joint.dofs.push_back(dofOf(turns.size() == 1 ? "turn" : "turn" + std::to_string(k + 1),
                                   tss::DofKind::Rotation, turns[k], samples.rest));
    joint.drives.resize(joint.dofs.size());
    for (std::size_t k = 0; k < samples.all.size(); ++k) {
        std::vector<double> values;
        for (const auto* tracks : {&slides, &turns})
            for (const Track& track : *tracks) values.push_back(track.values[k]);
        const Eigen::Matrix3d known = tss::jointPose(joint, values).linear();
        found.off = std::max(found.off, (known - samples.all[k].pose.linear()).cwiseAbs().maxCoeff());
    }
    // Neither a text file's digits nor what was taken for standing still are worth a word for each bone.
    if (found.off <= samples.still) found.off = 0;
    if (joint.dofs.empty()) { // it stands as its first key has it
        joint.frame0 = samples.all.front().pose;
        joint.frame1 = tss::Pose::Identity();
    }
    found.joints = {joint};
    return found;
}

} // namespace osgTSS
