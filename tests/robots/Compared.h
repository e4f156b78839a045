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

/// How often each text was met.
using Tally = std::map<std::string, int>;

inline void printTally(const std::string& title, const Tally& tally) {
    for (const auto& [text, count] : tally) fmt::print("{}: {} times: {}\n", title, count, text);
}

} // namespace tss
