#include "bake/robot/Character.h"

#include "bake/base/Degrees.h"
#include "bake/character/CutByWeights.h"
#include "bake/character/KeyedJoint.h"
#include "bake/motion/SmallSystems.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace tss {

namespace {

/// The turn in a matrix, the nearest one; a mirror is left out of it.
Eigen::Matrix3d turnIn(const Eigen::Matrix3d& linear) {
    const SingularValues svd = singularValues(linear);
    Eigen::Matrix3d turn = svd.u * svd.v.transpose();
    if (turn.determinant() < 0) turn = -turn;
    return turn;
}

class Adder {
public:
    Adder(Robot& robot, const Character& character, int world, LeftOut& leftOut)
        : robot_(robot), character_(character), world_(world), leftOut_(leftOut),
          first_(static_cast<int>(robot.links.size())) {}

    void add() {
        for (const Character::Bone& bone : character_.bones) bound_.push_back(rigidBound(bone));
        for (std::size_t b = 0; b < character_.bones.size(); ++b) addBone(b);
        noteStretched();
        addBodies();
        for (const Character::Mesh& mesh : character_.meshes) addSkin(mesh);
        if (!character_.runs.empty() || moving_ == 0) return;
        leftOut_.add("no animation moves these bones: a joint leads from where they are bound to where they "
                     "stand",
                     character_.name);
    }

private:
    static Pose rigidBound(const Character::Bone& bone) {
        Pose pose = Pose::Identity();
        pose.linear() = turnIn(bone.bound.linear());
        pose.translation() = bone.bound.translation();
        return pose;
    }

    /// Where a bone that stands so stands as a rigid body.
    Pose rigid(std::size_t bone, const Eigen::Affine3d& place) {
        const Eigen::Affine3d moved = place * character_.bones[bone].bound.inverse();
        const Eigen::Matrix3d turn = turnIn(moved.linear());
        constexpr double rounded = 0.01;
        const double stretch =
            (turn.transpose() * moved.linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
        if (stretch > rounded) stretched_.insert(bone);
        Pose pose = Pose::Identity();
        pose.linear() = turn * bound_[bone].linear();
        pose.translation() = place.translation();
        return pose;
    }

    Pose inParent(std::size_t bone, const std::vector<Eigen::Affine3d>& places) {
        const int parent = character_.bones[bone].parent;
        const Pose place = rigid(bone, places[bone]);
        if (parent >= 0) return rigid(parent, places[parent]).inverse(Eigen::Isometry) * place;
        return ofWorld().inverse(Eigen::Isometry) * place;
    }
    Pose ofWorld() const { return world_ >= 0 ? robot_.links[world_].place : Pose::Identity(); }

    KeyedPoses posesOf(std::size_t bone) {
        KeyedPoses poses;
        poses.anyTurn = true;
        for (const Character::Run& run : character_.runs)
            for (std::size_t k = 0; k < run.times.size(); ++k)
                poses.samples.push_back({inParent(bone, run.places[k]), k == 0});
        if (poses.samples.empty()) {
            std::vector<Eigen::Affine3d> stands;
            for (const Character::Bone& other : character_.bones) stands.push_back(other.stands);
            poses.samples.push_back({inParent(bone, stands), true});
        }
        const int parent = character_.bones[bone].parent;
        const Pose above = parent >= 0 ? bound_[parent] : ofWorld();
        poses.rest = poses.samples.size();
        poses.samples.push_back({above.inverse(Eigen::Isometry) * bound_[bone], true});
        for (const Pose& other : bound_)
            poses.size = std::max(poses.size, (other.translation() - bound_[0].translation()).norm());
        for (const KeyedPoses::Sample& sample : poses.samples)
            poses.size = std::max(poses.size, sample.pose.translation().norm());
        return poses;
    }

    void addBone(std::size_t b) {
        const Character::Bone& bone = character_.bones[b];
        RobotLink link;
        link.name = bone.name;
        link.place = bound_[b];
        link.visible = false;
        robot_.links.push_back(std::move(link));
        const KeyedPoses poses = posesOf(b);
        const KeyedJoint keyed = keyedJoint(poses);
        RobotJoint joint;
        joint.name = bone.name + "_joint";
        joint.where = bone.name;
        joint.parent = bone.parent >= 0 ? first_ + bone.parent : world_;
        joint.child = first_ + static_cast<int>(b);
        bodyOf_.push_back(static_cast<int>(b));
        if (keyed.joint.dofs.empty()) {
            joint.origin = poses.samples[poses.rest].pose;
            if (bone.parent >= 0) bodyOf_.back() = bodyOf_[bone.parent];
        } else {
            ++moving_;
            joint.frame = keyed.joint.frame1;
            joint.origin = keyed.joint.frame0 * keyed.joint.frame1.inverse(Eigen::Isometry);
            joint.dofs = keyed.joint.dofs;
            for (const std::vector<double>& values : keyed.values) joint.drives.push_back(drive(values));
        }
        robot_.joints.push_back(std::move(joint));
    }

    /// Values of a DOF at all samples of all runs over time.
    TimeSamples drive(const std::vector<double>& values) const {
        TimeSamples samples;
        if (character_.runs.empty()) return {{robot_.startTimeCode}, {values[0]}};
        std::size_t next = 0;
        for (const Character::Run& run : character_.runs) {
            const double start =
                samples.empty() ? run.times.front() : samples.times.back() + robot_.timeCodesPerSecond;
            for (const double time : run.times) {
                samples.times.push_back(start + time - run.times.front());
                samples.values.push_back(values[next++]);
            }
        }
        return samples;
    }

    void noteStretched() {
        for (const std::size_t bone : stretched_)
            leftOut_.add("left out: animated scales; these bones keep the size that they are bound in",
                         character_.bones[bone].name);
    }

    void addBodies() {
        std::vector<Holder> holders;
        for (const int body : bodyOf_)
            holders.push_back({body, Eigen::Affine3d(bound_[body].inverse(Eigen::Isometry))});
        std::vector<HeldMesh> meshes;
        for (const Character::Mesh& mesh : character_.meshes) {
            HeldMesh held;
            held.points = mesh.surface.vertices;
            for (const Tri& t : mesh.surface.triangles)
                held.triangles.push_back(
                    {static_cast<unsigned>(t[0]), static_cast<unsigned>(t[1]), static_cast<unsigned>(t[2])});
            for (const auto& weights : mesh.weights) {
                auto& of = held.weights.emplace_back();
                for (const auto& [bone, weight] : weights) of.emplace_back(bone, static_cast<float>(weight));
            }
            meshes.push_back(std::move(held));
        }
        std::map<int, BodyPart> parts = cutByWeights(holders, meshes);
        addSeams(parts);
        for (auto& [body, part] : parts) {
            RobotLink& link = robot_.links[first_ + body];
            RobotShape shape;
            shape.mesh = std::make_shared<const TriangleMesh>(std::move(part.surface));
            shape.where = link.name;
            link.collision = link.visual = {shape};
        }
    }

    /// Two bones that follow one another and of which the one's body was cut off the other's.
    void addSeams(const std::map<int, BodyPart>& parts) {
        for (const auto& [b, part] : parts) {
            int above = character_.bones[b].parent;
            while (above >= 0 && !parts.contains(above)) above = character_.bones[above].parent;
            if (above >= 0 && part.neighbours.contains(above))
                robot_.seams.emplace_back(nameOf(above), nameOf(b));
        }
    }

    const std::string& nameOf(int bone) const { return robot_.links[first_ + bone].name; }

    /// Vertices at one place with the same weights are one.
    void addSkin(const Character::Mesh& mesh) {
        RobotSkin skin;
        skin.name = mesh.name;
        skin.color = mesh.color;
        skin.visible = mesh.visible;
        std::vector<std::map<int, double>> shares; // of bodies
        std::map<std::tuple<double, double, double, std::map<int, double>>, int> known;
        std::vector<int> places;
        std::size_t loose = 0;
        for (std::size_t v = 0; v < mesh.surface.vertices.size(); ++v) {
            std::map<int, double> share = shareOf(mesh.weights[v]);
            loose += mesh.weights[v].empty();
            const Vec3& at = mesh.surface.vertices[v];
            const auto [entry, fresh] = known.emplace(std::tuple(at.x(), at.y(), at.z(), share),
                                                      static_cast<int>(skin.mesh.vertices.size()));
            places.push_back(entry->second);
            if (!fresh) continue;
            skin.mesh.vertices.push_back(at);
            shares.push_back(std::move(share));
        }
        for (const Tri& t : mesh.surface.triangles) {
            const Tri moved(places[t[0]], places[t[1]], places[t[2]]);
            if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
                skin.mesh.triangles.push_back(moved);
        }
        if (loose > 0)
            leftOut_.add("meshes with vertices that no bone holds, which go with " + nameOf(bodyOf_[0]),
                         mesh.name + " (" + std::to_string(loose) + ")");
        setWeights(shares, skin);
        robot_.skins.push_back(std::move(skin));
    }

    std::map<int, double> shareOf(const std::vector<std::pair<int, double>>& weights) const {
        std::map<int, double> share;
        double sum = 0;
        for (const auto& [bone, weight] : weights) share[bodyOf_[bone]] += weight, sum += weight;
        for (auto& [body, weight] : share) weight /= sum;
        if (share.empty()) share[bodyOf_[0]] = 1;
        return share;
    }

    void setWeights(const std::vector<std::map<int, double>>& shares, RobotSkin& skin) const {
        std::map<int, std::uint32_t> placeOf;
        for (const auto& share : shares) {
            skin.influences = std::max(skin.influences, share.size());
            for (const auto& [body, weight] : share) placeOf.emplace(body, 0u);
        }
        for (auto& [body, place] : placeOf) {
            place = static_cast<std::uint32_t>(skin.links.size());
            skin.links.push_back(first_ + body);
        }
        for (std::size_t v = 0; v < shares.size(); ++v) {
            for (const auto& [body, weight] : shares[v]) {
                skin.indices.push_back(placeOf.at(body));
                skin.weights.push_back(weight);
            }
            skin.indices.resize((v + 1) * skin.influences, 0);
            skin.weights.resize((v + 1) * skin.influences, 0);
        }
    }

    Robot& robot_;
    const Character& character_;
    const int world_;
    LeftOut& leftOut_;
    const int first_;         ///< link of the first bone
    std::vector<Pose> bound_; ///< of each bone
    std::vector<int> bodyOf_; ///< of each bone: itself, or the one above that it stands in
    std::size_t moving_ = 0;
    std::set<std::size_t> stretched_;
};

} // namespace

Character::Run sampledRun(const Character& character, const std::vector<double>& keys,
                          const PlacesAt& placesAt) {
    const double step = toRadians(5);
    constexpr double most = 100; // between two keys
    const auto turnsAt = [&](const std::vector<Eigen::Affine3d>& places) {
        std::vector<Eigen::Quaterniond> turns;
        for (std::size_t b = 0; b < places.size(); ++b) {
            const int parent = character.bones[b].parent;
            const Eigen::Matrix3d turn = turnIn(places[b].linear());
            turns.emplace_back(
                parent < 0 ? turn : Eigen::Matrix3d(turnIn(places[parent].linear()).transpose() * turn));
        }
        return turns;
    };
    Character::Run run;
    std::vector<Eigen::Quaterniond> before;
    for (const double key : keys) {
        std::vector<Eigen::Affine3d> places = placesAt(key);
        std::vector<Eigen::Quaterniond> turns = turnsAt(places);
        double farthest = 0;
        for (std::size_t b = 0; b < before.size(); ++b)
            farthest = std::max(farthest, before[b].angularDistance(turns[b]));
        const int steps = static_cast<int>(std::min(std::ceil(farthest / step), most));
        const double last = run.times.empty() ? key : run.times.back();
        for (int k = 1; k < steps; ++k) {
            run.times.push_back(last + (key - last) * k / steps);
            run.places.push_back(placesAt(run.times.back()));
        }
        run.times.push_back(key);
        run.places.push_back(std::move(places));
        before = std::move(turns);
    }
    return run;
}

void addCharacter(Robot& robot, const Character& character, int world, LeftOut& leftOut) {
    Adder(robot, character, world, leftOut).add();
}

} // namespace tss
