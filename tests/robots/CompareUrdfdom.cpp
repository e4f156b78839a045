// Reads URDF files with urdfdom and with readUrdf(), and says where a link, a joint, a shape or a pair is
// another: compare_urdfdom FILE.urdf... Exit status 1 where one of them differs. The reader leans on urdfdom
// too, of a text that it has tidied first: this one reads the file as it is. What docs/ROBOTS.md says is left
// out or taken otherwise is no difference where it is said of that link or joint.
#include "bake/geometry/Import.h"
#include "bake/robot/ReadRobot.h"
#include "tests/robots/Compared.h"

#include <console_bridge/console.h>
#include <numbers>
#include <random>
#include <set>
#include <urdf_parser/urdf_parser.h>

using namespace tss;

namespace {

constexpr double pi = std::numbers::pi, close = 1e-6;

using Theirs = urdf::ModelInterfaceSharedPtr;

struct Silent : console_bridge::OutputHandler {
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first.empty()) first = text;
    }
    std::string first;
};

Vec3 vectorOf(const urdf::Vector3& v) {
    return {v.x, v.y, v.z};
}

Pose poseOf(const urdf::Pose& of) {
    const urdf::Rotation& r = of.rotation; // its angles are less right than this
    Pose pose = Pose::Identity();
    pose.translate(vectorOf(of.position)).rotate(Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized());
    return pose;
}

/// How a joint moves: what it is led by counts, not its own limits.
struct Range {
    double lower = 0, upper = 0;
    bool endless = false, moves = false, circles = false;
};

class Comparison {
public:
    Comparison(const std::string& file, const urdf::ModelInterface& theirs, const Own& own,
               Differences& differences)
        : file_(file), theirs_(theirs), own_(own), robot_(own.robot), differ_(differences),
          above_(holders(own.robot)),
          random_(std::hash<std::string>()(file.substr(file.find_last_of('/') + 1))) {}

    /// The number of links that were compared.
    int compare() {
        if (robot_.links.size() != theirs_.links_.size())
            return differ_.add(
                       fmt::format("{} links, urdfdom has {}", robot_.links.size(), theirs_.links_.size())),
                   0;
        for (std::size_t link = 0; link < robot_.links.size(); ++link) {
            if (!theirs_.getLink(robot_.links[link].name))
                return differ_.add("link " + robot_.links[link].name + ": urdfdom has none"), 0;
            compareJoint(static_cast<int>(link));
            compareShape(static_cast<int>(link));
        }
        for (int k = 0; k < 20; ++k) comparePoses(k);
        comparePairs();
        return static_cast<int>(robot_.links.size());
    }

private:
    urdf::JointConstSharedPtr jointOf(int link) const {
        return theirs_.getLink(robot_.links[link].name)->parent_joint;
    }

    static Range ownRange(const urdf::Joint& joint) {
        Range range;
        range.endless =
            joint.type == urdf::Joint::CONTINUOUS ||
            (joint.type == urdf::Joint::REVOLUTE && joint.limits->upper - joint.limits->lower > 1e5);
        range.moves =
            range.endless || joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
        if (range.endless) {
            range.lower = -pi;
            range.upper = pi;
        } else if (range.moves) {
            range.lower = joint.limits->lower;
            range.upper = joint.limits->upper;
            range.moves = range.lower <= range.upper; // else it is left out
        }
        return range;
    }

    /// Through what leads it. What mimics a joint that does not move within limits moves by itself; of those
    /// that mimic each other in a circle some one does.
    Range rangeOf(const urdf::Joint& joint) const {
        const Range own = ownRange(joint);
        double factor = 1, offset = 0;
        const urdf::Joint* at = &joint;
        for (std::size_t steps = 0; at->mimic; ++steps) {
            if (steps > theirs_.joints_.size())
                return Range{own.lower, own.upper, own.endless, own.moves, true};
            const auto leader = theirs_.joints_.find(at->mimic->joint_name);
            if (leader == theirs_.joints_.end() || !ownRange(*leader->second).moves) break;
            offset += factor * at->mimic->offset;
            factor *= at->mimic->multiplier;
            at = leader->second.get();
        }
        if (at == &joint) return own;
        const Range leads = ownRange(*at);
        Range led = own;
        led.endless = false;
        if (leads.endless && factor != 0) {
            if (joint.type == urdf::Joint::PRISMATIC) {
                led.moves = own.lower < own.upper;
                return led;
            }
            const double half = pi * std::max(1.0, std::abs(factor));
            led.lower = offset - half;
            led.upper = offset + half;
            return led;
        }
        led.lower = std::min(factor * leads.lower, factor * leads.upper) + offset;
        led.upper = std::max(factor * leads.lower, factor * leads.upper) + offset;
        return led;
    }

    void compareJoint(int link) {
        const auto theirs = jointOf(link);
        const std::string at = "link " + robot_.links[link].name;
        if (!theirs || above_[link] < 0) {
            const bool fits = !theirs || vectorOf(theirs->axis).isZero(0) ||
                              (theirs->type != urdf::Joint::FIXED && !rangeOf(*theirs).moves);
            if (above_[link] >= 0) differ_.add(at + ": hangs on a joint, not so by urdfdom");
            if (!fits) differ_.add(at + ": its joint is left out");
            return;
        }
        const RobotJoint& own = robot_.joints[above_[link]];
        const std::string name = "joint " + own.name;
        if (own.name != theirs->name) differ_.add(name + ": urdfdom calls it " + theirs->name);
        if (own.parent < 0 || robot_.links[own.parent].name != theirs->parent_link_name)
            differ_.add(name + ": another parent");
        if (theirs->type == urdf::Joint::FIXED) {
            if (!own.dofs.empty()) differ_.add(name + ": moves");
            return;
        }
        const Range range = rangeOf(*theirs);
        if (range.circles) return;
        if (!range.moves) return differ_.add(name + ": is not left out");
        if (range.lower == range.upper) {
            if (!own.dofs.empty()) differ_.add(name + ": moves, by its limits it does not");
            return;
        }
        if (own.dofs.size() != 1) return differ_.add(name + ": does not move");
        const Dof& dof = own.dofs[0];
        if ((dof.kind == DofKind::Translation) != (theirs->type == urdf::Joint::PRISMATIC))
            differ_.add(name + ": another kind");
        if ((dof.axis - vectorOf(theirs->axis).normalized()).norm() > close)
            differ_.add(name + ": another axis");
        if (std::abs(dof.lower - range.lower) > close || std::abs(dof.upper - range.upper) > close)
            differ_.add(fmt::format("{}: limits {} to {}, by urdfdom {} to {}", name, dof.lower, dof.upper,
                                    range.lower, range.upper));
    }

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

    void comparePoses(int round) {
        std::vector<std::vector<double>> values(robot_.joints.size());
        std::map<std::string, double> theirValues;
        for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
            for (const Dof& dof : robot_.joints[j].dofs)
                values[j].push_back(round == 0 ? std::clamp(0.0, dof.lower, dof.upper)
                                               : between(dof.lower, dof.upper));
            const Range range = rangeOf(*theirs_.getJoint(robot_.joints[j].name));
            if (range.circles && values[j].empty()) return;
            theirValues[robot_.joints[j].name] = values[j].empty() ? range.lower : values[j][0];
        }
        const std::vector<Pose> poses = posedBodies(own_.made.scene, sceneValues(robot_, values));
        for (std::size_t link = 0; link < robot_.links.size(); ++link) {
            Pose their = Pose::Identity();
            int at = static_cast<int>(link);
            for (; above_[at] >= 0; at = robot_.joints[above_[at]].parent) {
                const urdf::Joint& joint = *jointOf(at);
                Pose moved = poseOf(joint.parent_to_joint_origin_transform);
                const Vec3 axis = vectorOf(joint.axis).normalized();
                const double value = theirValues[joint.name];
                if (joint.type == urdf::Joint::PRISMATIC)
                    moved.translate(value * axis);
                else if (joint.type != urdf::Joint::FIXED)
                    moved.rotate(Eigen::AngleAxisd(value, axis));
                their = moved * their;
            }
            const Pose own = poses[at].inverse(Eigen::Isometry) * poses[link];
            const double apart = (own.matrix() - their.matrix()).norm();
            if (apart > close * (1 + their.translation().norm()))
                return differ_.add(
                    fmt::format("link {}: its pose differs by {}", robot_.links[link].name, apart));
        }
    }

    Solid solidOf(const urdf::Geometry& geometry, const Pose& place) const {
        Solid solid;
        solid.place = place;
        if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
            solid.kind = RobotShape::Kind::Box;
            solid.size = vectorOf(box->dim) / 2;
        } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
            solid.kind = RobotShape::Kind::Sphere;
            solid.size = {sphere->radius, 0, 0};
        } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
            solid.kind = RobotShape::Kind::Cylinder;
            solid.size = {cylinder->radius, cylinder->length / 2, 0};
        } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&geometry)) {
            solid.corners = importMesh(meshesOf(file_, {})(mesh->filename)).vertices;
            for (Vec3& p : solid.corners) p = p.cwiseProduct(vectorOf(mesh->scale));
        }
        return solid;
    }

    template <class Items>
    std::vector<Solid> solidsOf(const Items& items) const {
        std::vector<Solid> solids;
        for (const auto& item : items) solids.push_back(solidOf(*item->geometry, poseOf(item->origin)));
        std::erase_if(solids, [](const Solid& s) { return s.corners.empty() && s.size.isZero(0); }); // points
        return solids;
    }

    void compareShape(int link) {
        const std::string at = "link " + robot_.links[link].name;
        if (isLacking(own_.made, robot_.links[link].name)) return;
        const auto theirs = theirs_.getLink(robot_.links[link].name);
        const TriangleMesh& mesh = own_.made.scene.bodies[link].mesh;
        std::vector<Solid> solids = solidsOf(theirs->collision_array);
        if (solids.empty()) solids = solidsOf(theirs->visual_array);
        if (solids.empty() != mesh.empty()) return differ_.add(at + ": one has a shape, the other none");
        if (const std::string words = shapeDifference(mesh, solids); !words.empty())
            differ_.add(at + ": " + words);
    }

    void comparePairs() {
        std::set<std::pair<int, int>> made;
        for (const Pair& pair : own_.made.scene.pairs)
            made.insert({std::min(pair.bodyA, pair.bodyB), std::max(pair.bodyA, pair.bodyB)});
        const int count = static_cast<int>(robot_.links.size());
        for (int a = 0; a < count; ++a)
            for (int b = a + 1; b < count; ++b) {
                if (rootOf(robot_, above_, a) != rootOf(robot_, above_, b)) continue;
                std::set<int> way;
                for (int end : {a, b})
                    for (int at = end; above_[at] >= 0; at = robot_.joints[above_[at]].parent)
                        if (!way.insert(above_[at]).second) way.erase(above_[at]);
                std::size_t values = 0;
                for (int j : way) values += robot_.joints[j].dofs.size();
                const bool shapeless =
                    own_.made.scene.bodies[a].mesh.empty() || own_.made.scene.bodies[b].mesh.empty();
                const bool wanted = !shapeless && values > 0 && values <= maxDofs;
                if (wanted != made.contains({a, b}))
                    differ_.add(fmt::format("links {} and {}: {} pair", robot_.links[a].name,
                                            robot_.links[b].name, wanted ? "no" : "a"));
            }
    }

    std::string file_;
    const urdf::ModelInterface& theirs_;
    const Own& own_;
    const Robot& robot_;
    Differences& differ_;
    std::vector<int> above_; ///< the joint that holds a link
    std::mt19937 random_;
};

Tally lenient, strict;
int refused = 0; ///< by both

/// What docs/ROBOTS.md says is refused.
bool isSaid(const std::string& refusal) {
    for (const char* words : {"no more than", "document type", "no link has a shape that can be had",
                              "no folder of a package", "UTF-8", "and no other place", "xacro"})
        if (refusal.find(words) != refusal.npos) return true;
    return false;
}

bool same(const std::string& file, int& links) {
    Differences differences(file);
    const std::string text = readWholeFile(file);
    const Own own = readOwn([&] { return readUrdf(text, file); }, file);
    Silent silent;
    console_bridge::useOutputHandler(&silent);
    Theirs theirs;
    try {
        // Of a loop urdfdom makes links that hold each other for ever.
        if (own.refusal.find("close a loop") == own.refusal.npos) theirs = urdf::parseURDF(text);
    } catch (const std::exception& error) {
        silent.first = error.what();
    }
    console_bridge::restorePreviousOutputHandler();
    if (!silent.first.empty()) theirs.reset(); // it gives what it had read until there
    if (!theirs) {
        refused += !own.refusal.empty();
        if (own.refusal.empty()) ++lenient[silent.first.substr(0, silent.first.find('\n'))];
    } else if (own.refusal.empty()) {
        links += Comparison(file, *theirs, own, differences).compare();
    } else if (isSaid(own.refusal)) {
        ++strict[reasonOf(own.refusal)];
    } else {
        differences.add("refused here: " + own.refusal);
    }
    return !differences.any();
}

} // namespace

int main(int count, char** files) {
    int differ = 0, links = 0;
    for (int k = 1; k < count; ++k) differ += !same(files[k], links);
    printTally("read here, refused by urdfdom", lenient);
    printTally("refused here as the documentation says", strict);
    fmt::print("{} files, {} refused by both, {} links that both read, {} files differ\n", count - 1, refused,
               links, differ);
    return differ > 0;
}
