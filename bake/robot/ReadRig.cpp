#include "bake/robot/ReadRig.h"

#include "bake/base/Error.h"
#include "bake/base/Words.h"
#include "bake/robot/Character.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

namespace tss {

namespace {

using Places = std::vector<Eigen::Affine3d>; ///< of nodes

constexpr double codesPerSecond = 24;

/// assimp cuts a node of FBX into several of this in their names, the last of which has the node's own.
constexpr const char* pivotMark = "_$AssimpFbx$_";

/// The value at a time, by mix(before, after, share) between keys; the fallback where there is none.
template <class Value, class Mix>
Value valueAt(const std::vector<double>& times, const std::vector<Value>& values, double time,
              const Value& fallback, const Mix& mix) {
    if (times.empty()) return fallback;
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times, time) - times.begin());
    if (next == 0) return values.front();
    if (next == times.size()) return values.back();
    return mix(values[next - 1], values[next], (time - times[next - 1]) / (times[next] - times[next - 1]));
}

Eigen::Affine3d localAt(const RigFile::Channel& channel, double time) {
    const auto line = [](const Vec3& a, const Vec3& b, double t) -> Vec3 { return a + t * (b - a); };
    const auto arc = [](const Eigen::Vector4d& a, const Eigen::Vector4d& b, double t) -> Eigen::Vector4d {
        return Eigen::Quaterniond(a).normalized().slerp(t, Eigen::Quaterniond(b).normalized()).coeffs();
    };
    const Vec3 place = valueAt<Vec3>(channel.placeTimes, channel.places, time, Vec3::Zero(), line),
               scale = valueAt<Vec3>(channel.scaleTimes, channel.scales, time, Vec3::Ones(), line);
    const Eigen::Vector4d turn =
        valueAt<Eigen::Vector4d>(channel.turnTimes, channel.turns, time, {0, 0, 0, 1}, arc);
    return Eigen::Translation3d(place) * Eigen::Quaterniond(turn).normalized() * Eigen::Scaling(scale);
}

class Rigging {
public:
    Rigging(const RigFile& rig, const std::string& file) : rig_(rig) {
        robot_.file = file;
        robot_.name = std::filesystem::path(file).stem().string();
        robot_.metersPerUnit = rig.notes.metersPerUnit > 0 ? rig.notes.metersPerUnit : 1;
        robot_.upAxis = rig.notes.upAxis == 'Y' ? 'Y' : 'Z';
        robot_.timeCodesPerSecond = codesPerSecond;
        for (const std::string& what : rig.notes.leftOut) robot_.notes.push_back("left out: " + what);
    }

    Robot read() {
        findBones();
        stands_ = composed({});
        findBound();
        for (std::size_t n = 0; n < rig_.nodes.size(); ++n) {
            if (boneOf_[n] < 0) continue;
            const int above = boneAbove(rig_.nodes[n].parent);
            character_.bones.push_back({freeName(rig_.nodes[n].name), above, bound_[n], stands_[n]});
        }
        character_.name = robot_.name;
        for (const RigFile::Mesh& mesh : rig_.meshes) addMesh(mesh);
        for (const RigFile::Animation& animation : rig_.animations) addRun(animation);
        LeftOut leftOut;
        addCharacter(robot_, character_, -1, leftOut);
        for (const RobotJoint& joint : robot_.joints)
            for (const TimeSamples& drive : joint.drives)
                robot_.endTimeCode = std::max(robot_.endTimeCode, drive.times.back());
        for (const std::string& note : leftOut.notes()) robot_.notes.push_back(note);
        if (rig_.animations.size() > 1)
            robot_.notes.push_back(std::to_string(rig_.animations.size()) +
                                   " animations, played one after the other");
        settleRobot(robot_);
        return std::move(robot_);
    }

private:
    std::string freeName(const std::string& wanted) {
        const std::string stem = wanted.empty() ? "node" : wanted;
        std::string name = stem;
        for (int k = 2; !names_.insert(name).second; ++k) name = stem + std::to_string(k);
        return name;
    }

    std::size_t nodeCalled(const std::string& name, std::size_t fallback) const {
        const auto found = std::ranges::find(rig_.nodes, name, &RigFile::Node::name);
        return found != rig_.nodes.end() ? static_cast<std::size_t>(found - rig_.nodes.begin()) : fallback;
    }

    bool isPivot(std::size_t node) const {
        return rig_.nodes[node].name.find(pivotMark) != std::string::npos;
    }

    /// Nodes that something moves or follows, and those on the ways between them.
    void findBones() {
        const std::size_t count = rig_.nodes.size();
        std::vector<std::size_t> below(count, 0); // bones at it and below it
        const auto mark = [&](std::size_t node) {
            const std::string& name = rig_.nodes[node].name;
            below[nodeCalled(name.substr(0, name.find(pivotMark)), node)] = 1;
        };
        for (const RigFile::Mesh& mesh : rig_.meshes)
            for (const auto& [node, offset] : mesh.bones) mark(static_cast<std::size_t>(node));
        for (const RigFile::Animation& animation : rig_.animations)
            for (const RigFile::Channel& channel : animation.channels)
                mark(static_cast<std::size_t>(channel.node));
        const std::vector<std::size_t> own = below;
        for (std::size_t n = count; n-- > 1;) below[rig_.nodes[n].parent] += below[n];
        if (below[0] == 0)
            throw InputError(Where{robot_.file},
                             "holds neither bones nor animations, so that nothing in it moves; expected a "
                             "robot's file, a rigged character, or two meshes as --a and --b");
        // The lowest node that has all of them is the first.
        std::size_t top = 0;
        for (std::size_t n = 0; n < count; ++n)
            if (below[n] == below[0]) top = n;
        for (int at = static_cast<int>(top); at >= 0 && isPivot(top); at = rig_.nodes[at].parent)
            top = static_cast<std::size_t>(at);
        boneOf_.assign(count, -1);
        int bones = 0;
        for (std::size_t n = 0; n < count; ++n)
            if (below[n] > 0 && isBelow(n, top) && (own[n] > 0 || !isPivot(n))) boneOf_[n] = bones++;
    }

    bool isBelow(std::size_t node, std::size_t top) const {
        int at = static_cast<int>(node);
        while (at > static_cast<int>(top)) at = rig_.nodes[at].parent;
        return at == static_cast<int>(top);
    }

    int boneAbove(int node) const {
        while (node >= 0 && boneOf_[node] < 0) node = rig_.nodes[node].parent;
        return node < 0 ? -1 : boneOf_[node];
    }

    /// Of all nodes in the file's frame, those of locals, by node, as these have them.
    Places composed(const std::map<int, Eigen::Affine3d>& locals) const {
        Places places;
        for (std::size_t n = 0; n < rig_.nodes.size(); ++n) {
            const auto moved = locals.find(static_cast<int>(n));
            const Eigen::Affine3d& local = moved != locals.end() ? moved->second : rig_.nodes[n].local;
            const int parent = rig_.nodes[n].parent;
            places.push_back(parent < 0 ? local : places[parent] * local);
        }
        return places;
    }

    static bool inverts(const Eigen::Affine3d& place) {
        return std::abs(place.linear().determinant()) > 1e-30;
    }

    /// A mesh, as it is bound, stands where the first of its bones is in the file, or is bound already.
    Eigen::Affine3d placeOfBound(const RigFile::Mesh& mesh) const {
        const auto first =
            std::ranges::min_element(mesh.bones, {}, [](const auto& bone) { return bone.first; });
        return (isBound_[first->first] ? bound_ : stands_)[first->first] * first->second;
    }

    void findBound() {
        const std::size_t count = rig_.nodes.size();
        bound_ = stands_;
        isBound_.assign(count, false);
        for (const RigFile::Mesh& mesh : rig_.meshes) {
            if (mesh.bones.empty()) continue;
            const Eigen::Affine3d place = placeOfBound(mesh);
            for (const auto& [node, offset] : mesh.bones) {
                if (isBound_[node] || !inverts(offset) || !inverts(place)) continue;
                bound_[node] = place * offset.inverse();
                isBound_[node] = true;
            }
        }
        const auto from = [&](std::size_t node, std::size_t other) { // as the two stand to each other
            if (!isBound_[other] || isBound_[node] || !inverts(stands_[other])) return;
            bound_[node] = bound_[other] * stands_[other].inverse() * stands_[node];
            isBound_[node] = true;
        };
        for (std::size_t n = count; n-- > 1;) from(static_cast<std::size_t>(rig_.nodes[n].parent), n);
        for (std::size_t n = 1; n < count; ++n) from(n, static_cast<std::size_t>(rig_.nodes[n].parent));
        for (std::size_t n = 0; n < count; ++n)
            if (boneOf_[n] >= 0 && !inverts(bound_[n]))
                throw InputError(Where{robot_.file},
                                 "node \"" + rig_.nodes[n].name + "\": expected a scale that is not 0");
    }

    void addMesh(const RigFile::Mesh& from) {
        const int above = boneAbove(from.node);
        if (from.bones.empty() && above < 0) return addStanding(from);
        Character::Mesh mesh;
        mesh.name = freeName(rig_.nodes[from.node].name);
        mesh.surface = from.surface;
        mesh.weights.resize(mesh.surface.vertices.size());
        const Eigen::Affine3d place = from.bones.empty() ? bound_[from.node] : placeOfBound(from);
        for (std::size_t v = 0; v < mesh.surface.vertices.size(); ++v) {
            Eigen::Matrix<double, 3, 4> sum = Eigen::Matrix<double, 3, 4>::Zero();
            double whole = 0;
            if (!from.bones.empty())
                for (const auto& [bone, weight] : from.weights[v]) {
                    const auto& [node, offset] = from.bones[bone];
                    if (boneOf_[node] < 0) continue;
                    mesh.weights[v].emplace_back(boneOf_[node], weight);
                    sum += weight * (bound_[node] * offset).matrix().topRows<3>();
                    whole += weight;
                }
            else
                mesh.weights[v] = {{above, 1}};
            const Vec3 point = mesh.surface.vertices[v];
            mesh.surface.vertices[v] =
                whole > 0 ? Vec3(sum * point.homogeneous() / whole) : Vec3(place * point);
        }
        turnRound(place, mesh.surface);
        character_.meshes.push_back(std::move(mesh));
    }

    static void turnRound(const Eigen::Affine3d& place, TriangleMesh& mesh) {
        if (place.linear().determinant() < 0)
            for (Tri& t : mesh.triangles) std::swap(t[1], t[2]);
    }

    /// What hangs on no bone.
    void addStanding(const RigFile::Mesh& from) {
        TriangleMesh mesh = from.surface;
        for (Vec3& v : mesh.vertices) v = stands_[from.node] * v;
        turnRound(stands_[from.node], mesh);
        RobotLink link;
        link.name = freeName(rig_.nodes[from.node].name);
        RobotShape shape;
        shape.mesh = std::make_shared<const TriangleMesh>(welded(mesh));
        shape.where = link.name;
        link.collision = link.visual = {shape};
        RobotJoint joint;
        joint.name = link.name + "_still";
        joint.child = static_cast<int>(robot_.links.size());
        robot_.links.push_back(std::move(link));
        robot_.joints.push_back(std::move(joint));
    }

    void addRun(const RigFile::Animation& animation) {
        std::set<double> times;
        for (const RigFile::Channel& channel : animation.channels)
            for (const auto* keys : {&channel.placeTimes, &channel.turnTimes, &channel.scaleTimes})
                for (const double time : *keys) times.insert(codesPerSecond * time);
        if (times.empty()) return;
        character_.runs.push_back(sampledRun(character_, {times.begin(), times.end()}, [&](double time) {
            std::map<int, Eigen::Affine3d> locals;
            for (const RigFile::Channel& channel : animation.channels)
                locals[channel.node] = localAt(channel, time / codesPerSecond);
            const Places places = composed(locals);
            Places bones;
            for (std::size_t n = 0; n < places.size(); ++n)
                if (boneOf_[n] >= 0) bones.push_back(places[n]);
            return bones;
        }));
    }

    const RigFile& rig_;
    Robot robot_;
    Character character_;
    std::set<std::string> names_;
    std::vector<int> boneOf_;   ///< of each node its bone; -1: it is none
    Places stands_, bound_;     ///< of each node, in the file and when the meshes are bound
    std::vector<bool> isBound_; ///< of each node: some mesh says where it is bound
};

/// Letters and digits of a name after its last prefix, in lower case.
std::string plainName(const std::string& name) {
    std::string plain;
    for (const char c : name.substr(name.find_last_of(":|") + 1))
        if (std::isalnum(static_cast<unsigned char>(c))) plain += c;
    return lowerCase(plain);
}

} // namespace

void takeAnimations(RigFile& rig, const RigFile& other, const std::string& file) {
    if (other.animations.empty()) throw InputError(Where{file}, "holds no animation");
    std::map<std::string, int> exact, plain;
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
        exact.emplace(rig.nodes[n].name, static_cast<int>(n));
        plain.emplace(plainName(rig.nodes[n].name), static_cast<int>(n));
    }
    const double own = rig.notes.metersPerUnit, theirs = other.notes.metersPerUnit;
    const double scale = own > 0 && theirs > 0 ? theirs / own : 1;
    std::set<std::string> unknown;
    std::size_t known = 0;
    rig.animations = other.animations;
    for (RigFile::Animation& animation : rig.animations) {
        for (RigFile::Channel& channel : animation.channels) {
            const std::string& name = other.nodes[channel.node].name;
            const auto same = exact.find(name);
            const auto like = plain.find(plainName(name));
            channel.node = same != exact.end() ? same->second : like != plain.end() ? like->second : -1;
            if (channel.node < 0) unknown.insert(name);
            for (Vec3& place : channel.places) place *= scale;
        }
        std::erase_if(animation.channels, [](const RigFile::Channel& channel) { return channel.node < 0; });
        known += animation.channels.size();
    }
    const std::vector<std::string> names(unknown.begin(), unknown.end());
    if (known == 0)
        throw InputError(Where{file}, "moves none of the nodes of the character: " + firstOf(names, 5));
    if (!names.empty())
        rig.notes.leftOut.push_back("keys of " + counted(names.size(), "node") +
                                    " that the character does not have: " + firstOf(names, 5));
}

Robot rigRobot(const RigFile& rig, const std::string& file) {
    if (rig.meshes.empty())
        throw InputError(Where{file}, "holds no triangle, a mesh with faces was expected");
    return Rigging(rig, file).read();
}

} // namespace tss
