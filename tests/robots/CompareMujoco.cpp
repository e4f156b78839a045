// Reads MJCF files with MuJoCo and with readMjcf(), and says where a body, a joint, a shape or a pair is
// another: compare_mujoco FILE.xml... Exit status 1 where one of them differs. What docs/ROBOTS.md says is
// left out or taken otherwise is no difference where it is said of that body.
#include "bake/robot/ReadRobot.h"
#include "tests/robots/MujocoModel.h"

#include <algorithm>
#include <numbers>
#include <random>
#include <set>

using namespace tss;
using namespace mujoco;

namespace {

constexpr double pi = std::numbers::pi;

class Comparison {
public:
    Comparison(const std::string& file, const mjModel& model, const Own& own, bool urdf,
               Differences& differences)
        : m_(model), urdf_(urdf), own_(own), robot_(own.robot), differ_(differences),
          above_(holders(own.robot)),
          random_(std::hash<std::string>()(file.substr(file.find_last_of('/') + 1))) {}

    /// The number of bodies that were compared.
    int compare() {
        if (!matchBodies()) return 0;
        for (int body = 1; body < m_.nbody; ++body) compareJoints(body);
        for (int k = 0; k < 20; ++k) comparePoses(k);
        for (int body = 0; body < m_.nbody; ++body)
            if (links_[body] >= 0) compareShapes(body);
        comparePairs();
        return m_.nbody;
    }

private:
    std::string nameOf(int type, int id) const {
        const char* name = mj_id2name(&m_, type, id);
        return name ? name : "";
    }
    std::string bodyName(int body) const {
        const std::string name = nameOf(mjOBJ_BODY, body);
        return name.empty() ? fmt::format("body {} without a name", body) : "body " + name;
    }

    /// The link of each body. MuJoCo's are in the order of an MJCF; of a URDF they have names.
    bool matchBodies() {
        const bool solid = !urdf_ && !robot_.links.empty() && robot_.links[0].name == "world";
        links_.assign(m_.nbody, -1);
        if (solid) links_[0] = 0;
        if (static_cast<int>(robot_.links.size()) - solid != m_.nbody - 1) {
            differ_.add(fmt::format("{} bodies, MuJoCo has {}", robot_.links.size() - solid, m_.nbody - 1));
            return false;
        }
        for (int body = 1; body < m_.nbody; ++body) {
            const std::string name = nameOf(mjOBJ_BODY, body);
            const auto same = std::ranges::find(robot_.links, name, &RobotLink::name);
            const int link = links_[body] =
                urdf_ ? static_cast<int>(same - robot_.links.begin()) : body - 1 + solid;
            if (urdf_ && same == robot_.links.end()) return differ_.add("no link " + name), false;
            if (robot_.links[link].named ? name != robot_.links[link].name : !name.empty()) {
                differ_.add(fmt::format("{}: here it is {}", bodyName(body), robot_.links[link].name));
                return false;
            }
        }
        return true;
    }

    bool isTied(int body) const { return above_[links_[body]] >= 0; }

    /// The body that one hangs on in the end: one that is tied to nothing, or 0.
    int rootBody(int body) const {
        while (body != 0 && isTied(body)) body = m_.body_parentid[body];
        return body;
    }

    void compareJoints(int body) {
        const int first = m_.body_jntadr[body], count = m_.body_jntnum[body];
        const std::string at = bodyName(body);
        if (!isTied(body)) return checkUntied(body);
        const RobotJoint& joint = robot_.joints[above_[links_[body]]];
        const int parent = m_.body_parentid[body];
        if (joint.parent != links_[parent]) differ_.add(at + ": another parent");
        std::vector<Dof> dofs = joint.dofs;
        if (dofs.empty() && count == 1 && isHeld(first)) return;
        if (!joint.leader.empty()) return; // which MuJoCo does not know
        for (int j = first; j < first + count; ++j) {
            const std::string name = at + fmt::format(", joint {} {}", j - first, nameOf(mjOBJ_JOINT, j));
            const bool ball = m_.jnt_type[j] == mjJNT_BALL;
            if (dofs.size() < (ball ? 3 : 1)) return differ_.add(name + ": is not there");
            if (ball) {
                compareBall(j, {dofs.begin(), dofs.begin() + 3}, name);
            } else {
                compareDof(j, dofs[0], name);
            }
            dofs.erase(dofs.begin(), dofs.begin() + (ball ? 3 : 1));
        }
        if (!dofs.empty()) differ_.add(fmt::format("{}: {} values too many", at, dofs.size()));
    }

    /// A ball with limits may have no range; hinges and slides MuJoCo refuses then.
    bool isHeld(int j) const {
        return (m_.jnt_limited[j] || urdf_) && m_.jnt_range[2 * j] >= m_.jnt_range[2 * j + 1];
    }

    /// Free joints and slides without a range tie a body to nothing, and so does the hand of who moves mocap.
    void checkUntied(int body) {
        const int first = m_.body_jntadr[body], count = m_.body_jntnum[body];
        bool known = m_.body_mocapid[body] >= 0;
        for (int j = first; j < first + count; ++j)
            known |= m_.jnt_type[j] == mjJNT_FREE || (m_.jnt_type[j] == mjJNT_SLIDE && !m_.jnt_limited[j]) ||
                     isHeld(j);                                       // with limits and no range
        const bool alone = count == 0 && m_.body_parentid[body] == 0; // needs no joint to the world
        if (!known && !alone) differ_.add(bodyName(body) + ": is tied to nothing");
    }

    void compareDof(int j, const Dof& dof, const std::string& name) {
        const bool slide = m_.jnt_type[j] == mjJNT_SLIDE;
        if ((dof.kind == DofKind::Translation) != slide) return differ_.add(name + ": another kind");
        if ((dof.axis - vectorOf(m_.jnt_axis + 3 * j)).norm() > rounded)
            differ_.add(fmt::format("{}: axis {} {} {}, MuJoCo's {} {} {}", name, dof.axis.x(), dof.axis.y(),
                                    dof.axis.z(), m_.jnt_axis[3 * j], m_.jnt_axis[3 * j + 1],
                                    m_.jnt_axis[3 * j + 2]));
        if (!slide && (dof.origin - vectorOf(m_.jnt_pos + 3 * j)).norm() > rounded)
            differ_.add(name + ": another anchor");
        if (urdf_ && dof.upper - dof.lower > 2 * pi - rounded)
            return; // MuJoCo gives a continuous joint limits
        const double ref = m_.qpos0[m_.jnt_qposadr[j]];
        const bool limited = m_.jnt_limited[j] && (slide || m_.jnt_range[2 * j + 1] < 1e5);
        const double lower = limited ? m_.jnt_range[2 * j] - ref : -pi,
                     upper = limited ? m_.jnt_range[2 * j + 1] - ref : pi;
        if (std::abs(dof.lower - lower) > rounded || std::abs(dof.upper - upper) > rounded)
            differ_.add(fmt::format("{}: limits {} to {}, MuJoCo's {} to {}", name, dof.lower, dof.upper,
                                    lower, upper));
    }

    void compareBall(int j, const std::vector<Dof>& dofs, const std::string& name) {
        const double most = m_.jnt_limited[j] ? m_.jnt_range[2 * j + 1] : pi;
        for (int k = 0; k < 3; ++k) {
            const Dof& dof = dofs[k];
            const double needed = most < pi / 2 ? most : k == 1 ? pi / 2 : pi;
            if (dof.kind != DofKind::Rotation || dof.axis != Vec3::Unit(k) ||
                (dof.origin - vectorOf(m_.jnt_pos + 3 * j)).norm() > rounded)
                differ_.add(name + ": no ball");
            if (dof.lower > -needed + rounded || dof.upper < needed - rounded)
                differ_.add(name + ": limits of less than the ball's angle");
        }
    }

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

    /// Random values of the joints that are served, the same for both; the first time those of rest.
    void comparePoses(int round) {
        std::unique_ptr<mjData, DeleteData> data(mj_makeData(&m_));
        std::vector<std::vector<double>> values(robot_.joints.size());
        bool atZero = round == 0;
        for (int body = 1; body < m_.nbody; ++body) {
            if (!isTied(body)) continue;
            const int index = above_[links_[body]];
            const int first = m_.body_jntadr[body], count = m_.body_jntnum[body];
            if (robot_.joints[index].dofs.empty()) {
                if (!robot_.joints[index].leader.empty())
                    return; // held where it is led, which MuJoCo does not know
                if (urdf_ && count == 1) {
                    data->qpos[m_.jnt_qposadr[first]] = m_.jnt_range[2 * first];
                    atZero = false;
                }
                continue;
            }
            for (int j = first; j < first + count; ++j) {
                mjtNum* q = data->qpos + m_.jnt_qposadr[j];
                const int parts = m_.jnt_type[j] == mjJNT_BALL ? 3 : 1;
                Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
                for (int k = 0; k < parts; ++k) {
                    const std::size_t at = values[index].size();
                    if (at >= robot_.joints[index].dofs.size()) return; // said already
                    const Dof& dof = robot_.joints[index].dofs[at];
                    const double value = round == 0 ? 0 : between(dof.lower, dof.upper);
                    values[index].push_back(value);
                    turn = turn * Eigen::AngleAxisd(value, Vec3::Unit(k));
                    if (parts == 1) *q = m_.qpos0[m_.jnt_qposadr[j]] + value;
                }
                if (parts == 3) q[0] = turn.w(), q[1] = turn.x(), q[2] = turn.y(), q[3] = turn.z();
            }
            if (values[index].size() != robot_.joints[index].dofs.size()) return;
        }
        mj_kinematics(&m_, data.get());
        const std::vector<Pose> poses = posedBodies(own_.made.scene, sceneValues(robot_, values));
        for (int body = 1; body < m_.nbody; ++body) {
            const auto theirs = [&](int b) { return poseOf(data->xpos + 3 * b, data->xquat + 4 * b); };
            const int root = rootBody(body);
            const Pose rootPose = root == 0 ? Pose::Identity() : poses[links_[root]];
            const Pose own = rootPose.inverse(Eigen::Isometry) * poses[links_[body]];
            const Pose their = theirs(root).inverse(Eigen::Isometry) * theirs(body);
            const double apart = (own.matrix() - their.matrix()).norm();
            if (apart > rounded * (1 + their.translation().norm()))
                return differ_.add(
                    fmt::format("{}: its pose differs by {}, sample {}", bodyName(body), apart, round));
            if (atZero && (poses[links_[body]].matrix() - theirs(body).matrix()).norm() > rounded)
                return differ_.add(bodyName(body) + ": stands elsewhere in the world as modelled");
        }
    }

    bool collides(int geom) const {
        for (int p = 0; p < m_.npair; ++p)
            if (m_.pair_geom1[p] == geom || m_.pair_geom2[p] == geom) return true;
        return m_.geom_contype[geom] || m_.geom_conaffinity[geom];
    }
    static bool isEndless(int type) { return type == mjGEOM_PLANE || type == mjGEOM_HFIELD; }

    std::vector<int> geomsOf(int body, bool colliding) const {
        std::vector<int> geoms;
        for (int g = m_.body_geomadr[body]; g < m_.body_geomadr[body] + m_.body_geomnum[body]; ++g)
            if (collides(g) == colliding && !isEndless(m_.geom_type[g])) geoms.push_back(g);
        return geoms;
    }

    /// Whether it is said that a link has its visual geometry.
    bool hasOther(const std::string& link) const {
        return std::ranges::any_of(own_.made.notes, [&](const std::string& note) {
            return note.find("their other one is taken: ") != note.npos && note.find(link) != note.npos;
        });
    }

    void compareShapes(int body) {
        const TriangleMesh& mesh = own_.made.scene.bodies[links_[body]].mesh;
        std::vector<int> geoms = geomsOf(body, true);
        if (isLacking(own_.made, robot_.links[links_[body]].name)) {
            if (mesh.empty()) return;
            geoms = geomsOf(body, false); // the others alone, or none
        } else if (geoms.empty()) {
            geoms = geomsOf(body, false);
        }
        const bool discarded = geoms.empty() && hasOther(robot_.links[links_[body]].name); // by discardvisual
        if (geoms.empty() != mesh.empty() && !discarded)
            return differ_.add(fmt::format("{}: {} shape, MuJoCo has {} geoms", bodyName(body),
                                           mesh.empty() ? "no" : "a", geoms.size()));
        if (discarded) return;
        std::vector<Solid> solids;
        for (int g : geoms) solids.push_back(solidOf(m_, g));
        if (const std::string words = shapeDifference(mesh, solids); !words.empty())
            differ_.add(bodyName(body) + ": " + words);
    }

    /// Whether MuJoCo tests geoms of two bodies ever.
    bool mayMeet(int a, int b) const {
        const int signature = ((a + 1) << 16) + b + 1;
        for (int p = 0; p < m_.npair; ++p) {
            if (isEndless(m_.geom_type[m_.pair_geom1[p]]) || isEndless(m_.geom_type[m_.pair_geom2[p]]))
                continue;
            const int one = m_.geom_bodyid[m_.pair_geom1[p]], other = m_.geom_bodyid[m_.pair_geom2[p]];
            if (std::min(one, other) == a && std::max(one, other) == b) return true;
        }
        for (int e = 0; e < m_.nexclude; ++e)
            if (m_.exclude_signature[e] == signature) return false;
        const int weldA = m_.body_weldid[a], weldB = m_.body_weldid[b];
        const auto above = [&](int weld) { return m_.body_weldid[m_.body_parentid[weld]]; };
        if (weldA == weldB) return false;
        if (weldA != 0 && weldB != 0 && (weldA == above(weldB) || weldB == above(weldA))) return false;
        for (int g : geomsOf(a, true))
            for (int h : geomsOf(b, true))
                if ((m_.geom_contype[g] & m_.geom_conaffinity[h]) ||
                    (m_.geom_contype[h] & m_.geom_conaffinity[g]))
                    return true;
        return false;
    }

    bool isExcluded(int a, int b) const {
        for (int e = 0; e < m_.nexclude; ++e)
            if (m_.exclude_signature[e] == ((a + 1) << 16) + b + 1) return true;
        return false;
    }

    /// The values that lie between two bodies; 0: they do not move against each other.
    std::size_t valuesBetween(int a, int b) const {
        std::map<int, std::size_t> way;
        std::size_t count = 0;
        for (int at = a; at != 0 && isTied(at); at = m_.body_parentid[at])
            way[at] = robot_.joints[above_[links_[at]]].dofs.size();
        for (int at = b; at != 0 && isTied(at); at = m_.body_parentid[at])
            if (!way.erase(at)) count += robot_.joints[above_[links_[at]]].dofs.size();
        for (const auto& [at, dofs] : way) count += dofs;
        return count;
    }

    void comparePairs() {
        std::set<std::pair<int, int>> made;
        for (const Pair& pair : own_.made.scene.pairs)
            made.insert({std::min(pair.bodyA, pair.bodyB), std::max(pair.bodyA, pair.bodyB)});
        for (int a = 0; a < m_.nbody; ++a)
            for (int b = a + 1; b < m_.nbody; ++b) {
                if (links_[a] < 0 || rootBody(a) != rootBody(b)) continue;
                const auto shapeless = [&](int body) {
                    return own_.made.scene.bodies[links_[body]].mesh.empty();
                };
                const bool has = made.contains(std::minmax(links_[a], links_[b]));
                const std::size_t values = valuesBetween(a, b);
                const bool can = !shapeless(a) && !shapeless(b) && values > 0 && values <= maxDofs;
                const std::string at = bodyName(a) + " and " + bodyName(b);
                if (can && !has && mayMeet(a, b)) differ_.add(at + ": no pair, MuJoCo tests them");
                if (has && isExcluded(a, b) && !mayMeet(a, b))
                    differ_.add(at + ": a pair, though they are excluded");
            }
    }

    const mjModel& m_;
    const bool urdf_;
    const Own& own_;
    const Robot& robot_;
    Differences& differ_;
    std::vector<int> above_, links_; ///< the joint that holds a link, the link of a body
    std::mt19937 random_;
};

/// What docs/ROBOTS.md says is refused.
bool isSaid(const std::string& refusal) {
    for (const char* words :
         {"coordinate: expected local", "no more than", "no link has a shape that can be had"})
        if (refusal.find(words) != refusal.npos) return true;
    return false;
}

Tally lenient, strict;
int refused = 0; ///< by both

bool same(const std::string& file, int& bodies) {
    Differences differences(file);
    std::string refusal;
    const Model model = load(file, refusal);
    const std::string text = readWholeFile(file);
    const Own own = readOwn(
        [&] {
#ifdef OSGTSS_HAVE_URDF
            if (isUrdf(text)) return readUrdf(text, file);
#endif
            return readMjcf(text, file,
                            [&](const std::string& name) { return readWholeFile(meshesOf(file, {})(name)); });
        },
        file);
    if (!model) {
        refused += !own.refusal.empty();
        if (own.refusal.empty()) ++lenient[refusal.substr(0, refusal.find('\n'))];
        return true;
    }
    if (!own.refusal.empty()) {
        if (isSaid(own.refusal))
            ++strict[reasonOf(own.refusal)];
        else
            differences.add("refused here: " + own.refusal);
    } else {
        bodies += Comparison(file, *model, own, isUrdf(text), differences).compare();
    }
    return !differences.any();
}

void stop(const char* text) {
    fmt::print("MuJoCo: {}\n", text);
    std::exit(2);
}

} // namespace

int main(int count, char** files) {
    mju_user_error = stop;
    mju_user_warning = [](const char*) {};
    int differ = 0, bodies = 0;
    for (int k = 1; k < count; ++k) differ += !same(files[k], bodies);
    printTally("read here, refused by MuJoCo", lenient);
    printTally("refused here as the documentation says", strict);
    fmt::print("{} files, {} refused by both, {} bodies that both read, {} files differ\n", count - 1,
               refused, bodies, differ);
    return differ > 0;
}
