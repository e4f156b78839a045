#include "bake/robot/ReadRobot.h"
#include "bake/robot/Xml.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

namespace tss {

using tinyxml2::XMLElement;

namespace {

Vec3 vectorOf(const std::vector<double>& n, const Vec3& fallback) {
    return n.empty() ? fallback : Vec3(n[0], n[1], n[2]);
}

/// About x, then y, then z, none of which turns along.
Eigen::Quaterniond turnOf(const Vec3& rpy) {
    const double sr = std::sin(rpy[0] / 2), cr = std::cos(rpy[0] / 2), sp = std::sin(rpy[1] / 2),
                 cp = std::cos(rpy[1] / 2), sy = std::sin(rpy[2] / 2), cy = std::cos(rpy[2] / 2);
    const double x = sr * cp * cy - cr * sp * sy, y = cr * sp * cy + sr * cp * sy,
                 z = cr * cp * sy - sr * sp * cy, w = cr * cp * cy + sr * sp * sy;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    return {w / length, x / length, y / length, z / length};
}

/// What is said of a joint that is left out; `child`: the link that it holds, empty where there is none.
std::string leftOutJoint(const std::string& joint, const std::string& where, const std::string& why,
                         const std::string& child) {
    const std::string left = "joint " + joint + " (" + where + ") " + why + ": left out";
    return child.empty() ? left : left + ", " + child + " and what hangs on it are tied to nothing";
}

class UrdfReader {
public:
    UrdfReader(const XMLElement& top, const std::string& file, Robot& robot)
        : top_(top), file_(file), robot_(robot) {
        static const std::set<std::string> versions = {"1", "1.0", "1.1", "1.2"};
        const std::string version = textOf(top, "version", "1.0");
        if (!versions.contains(version))
            throw InputError(placeOf(file, top),
                             "version: expected 1.0, 1.1 or 1.2, found \"" + version + "\"");
        robot.name = textOf(top, "name");
        if (robot.name.empty()) robot.name = std::filesystem::path(file).stem().string();
        for (const std::string& name : namesOf("link")) robot.links.emplace_back().name = name;
        for (std::size_t k = 0; k < robot.links.size(); ++k) index_[robot.links[k].name] = int(k);
        namesOf("joint");
        if (robot.links.empty()) throw InputError(placeOf(file, top), "expected at least one <link>");
        each("link", [&](const XMLElement& link) { readLink(link); });
        noteRoots();
        each("joint", [&](const XMLElement& joint) { readJoint(joint); });
        checkForest(robot);
        placeLinks();
        leaveOut();
    }

private:
    template <class Visit>
    void each(const char* kind, const Visit& visit) const {
        for (auto* e = top_.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) visit(*e);
    }

    std::vector<std::string> namesOf(const char* kind) const {
        std::vector<std::string> names;
        std::set<std::string> seen;
        each(kind, [&](const XMLElement& element) {
            expectAttributes(element, {"name"});
            names.push_back(textOf(element, "name"));
            if (!seen.insert(names.back()).second)
                throw InputError(placeOf(file_, element),
                                 std::string("expected a name that no other ") + kind + " has");
        });
        return names;
    }

    void expectAttributes(const XMLElement& element, std::initializer_list<const char*> names) const {
        for (const char* name : names)
            if (textOf(element, name).empty())
                throw InputError(placeOf(file_, element), std::string("expected an attribute ") + name);
    }

    std::vector<double> numbers(const XMLElement& element, const char* attribute, std::size_t count) const {
        return numbersOf(file_, element, attribute, count, count);
    }
    double number(const XMLElement& element, const char* attribute, double fallback) const {
        const auto found = numbers(element, attribute, 1);
        return found.empty() ? fallback : found[0];
    }

    /// Where the origin of a joint, a visual or a collision puts it.
    Pose originOf(const XMLElement& element) const {
        Pose pose = Pose::Identity();
        const XMLElement* origin = element.FirstChildElement("origin");
        if (!origin) return pose;
        const auto q = numbers(*origin, "quat_xyzw", 4); // of URDF 1.1
        if (!q.empty() && origin->Attribute("rpy"))
            throw InputError(placeOf(file_, *origin), "expected one of rpy and quat_xyzw, found both");
        if (!q.empty() && !(Eigen::Vector4d(q.data()).norm() > 0))
            throw InputError(placeOf(file_, *origin), "quat_xyzw: expected one that is not zero");
        pose.translation() = vectorOf(numbers(*origin, "xyz", 3), Vec3::Zero());
        const Eigen::Quaterniond turn = q.empty() ? turnOf(vectorOf(numbers(*origin, "rpy", 3), Vec3::Zero()))
                                                  : Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
        // Exact where it turns nothing.
        if (!turn.vec().isZero(0)) pose.linear() = turn.normalized().toRotationMatrix();
        return pose;
    }

    /// The one shape of a visual or collision, which has what its kind needs; null where there is none.
    const XMLElement* shapeIn(const XMLElement& item) const {
        static const std::set<std::string_view> kinds = {"box", "cylinder", "sphere", "mesh", "capsule"};
        const XMLElement* geometry = item.FirstChildElement("geometry");
        const XMLElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
        for (const XMLElement* one = shape; one; one = one->NextSiblingElement())
            if (!kinds.contains(one->Name()))
                throw InputError(placeOf(file_, *one),
                                 std::string("a shape <") + one->Name() + "> is none of URDF's");
        if (geometry && geometry->NextSiblingElement("geometry"))
            throw InputError(placeOf(file_, item), "expected one <geometry>");
        if (shape && shape->NextSiblingElement())
            throw InputError(placeOf(file_, *shape->NextSiblingElement()),
                             "expected one shape in a <geometry>");
        return shape;
    }

    /// Nothing where there is none; one with a problem where it cannot be read.
    std::optional<RobotShape> readShape(const XMLElement& item) const {
        RobotShape shape;
        try {
            const XMLElement* found = shapeIn(item);
            shape.place = originOf(item);
            if (!found) return std::nullopt;
            shape.where = placeOf(file_, *found).pointer;
            const std::string_view kind = found->Name();
            if (kind == "mesh") {
                expectAttributes(*found, {"filename"});
                shape.file = textOf(*found, "filename");
                shape.size = vectorOf(numbers(*found, "scale", 3), Vec3::Ones());
            } else if (kind == "box") {
                expectAttributes(*found, {"size"});
                shape.kind = RobotShape::Kind::Box;
                shape.size = vectorOf(numbers(*found, "size", 3), Vec3::Zero());
            } else if (kind == "sphere") {
                expectAttributes(*found, {"radius"});
                shape.kind = RobotShape::Kind::Sphere;
                shape.size = {number(*found, "radius", 0), 0, 0};
            } else { // a capsule as Bullet and Drake have it
                expectAttributes(*found, {"radius", "length"});
                shape.kind = kind == "capsule" ? RobotShape::Kind::Capsule : RobotShape::Kind::Cylinder;
                shape.size = {number(*found, "radius", 0), number(*found, "length", 0), 0};
            }
        } catch (const InputError& error) {
            shape = {};
            shape.where = error.where.pointer;
            shape.problem = error.message;
        }
        return shape;
    }

    void readLink(const XMLElement& element) {
        RobotLink& link = robot_.links[index_.at(textOf(element, "name"))];
        for (auto* item = element.FirstChildElement(); item; item = item->NextSiblingElement()) {
            const bool visual = item->Name() == std::string_view("visual");
            if (!visual && item->Name() != std::string_view("collision")) continue;
            const std::optional<RobotShape> shape = readShape(*item);
            if (!shape) continue;
            (visual ? link.visual : link.collision).push_back(*shape);
            if (visual && shape->problem.empty() && !link.color) link.color = colorOf(*item);
        }
    }

    /// Linear RGB.
    std::optional<Vec3> colorOf(const XMLElement& visual) const {
        const auto linear = [](double c) { return std::pow(std::min(1.0, std::max(0.0, c)), 2.2); };
        const XMLElement* material = visual.FirstChildElement("material");
        if (!material) return std::nullopt;
        const XMLElement* color = material->FirstChildElement("color");
        each("material", [&](const XMLElement& one) {
            if (!color && textOf(one, "name") == textOf(*material, "name"))
                color = one.FirstChildElement("color");
        });
        if (!color) return std::nullopt;
        try {
            const auto rgba = numbers(*color, "rgba", 4);
            if (!rgba.empty()) return Vec3(linear(rgba[0]), linear(rgba[1]), linear(rgba[2]));
        } catch (const InputError&) { // no collision depends on it
        }
        return std::nullopt;
    }

    /// Links that no joint holds, but for the first.
    void noteRoots() {
        std::set<std::string> held;
        each("joint", [&](const XMLElement& joint) {
            if (const XMLElement* child = joint.FirstChildElement("child"))
                held.insert(textOf(*child, "link"));
        });
        bool first = true;
        for (const RobotLink& link : robot_.links) {
            if (held.contains(link.name)) continue;
            if (!first)
                robot_.notes.push_back("link " + link.name +
                                       " hangs on no joint: tied to nothing, as is what hangs on it");
            first = false;
        }
    }

    void readJoint(const XMLElement& element) {
        RobotJoint joint;
        joint.name = textOf(element, "name");
        joint.where = placeOf(file_, element).pointer;
        std::string unused; // why it is no joint of a scene
        try {
            joint.origin = originOf(element);
            // What a fixed joint has no use for, exporters write all the same, as an axis of zeros.
            const std::string type = textOf(element, "type");
            const Dof dof = type == "fixed" ? Dof() : readDof(element, joint);
            joint.parent = linkAt(element, "parent");
            joint.child = linkAt(element, "child");
            checkJoint(element, type);
            if (type == "planar" || type == "floating")
                unused = "is " + type + ", without limits";
            else if (type != "fixed" && dof.lower > dof.upper)
                unused = "has a lower limit above its upper one";
            else if (type != "fixed")
                joint.dofs.push_back(dof);
        } catch (const InputError& error) {
            const XMLElement* child = element.FirstChildElement("child");
            const std::string name = child ? textOf(*child, "link") : "";
            robot_.notes.push_back(leftOutJoint(joint.name, error.where.pointer,
                                                "cannot be read (" + error.message + ")",
                                                index_.contains(name) ? name : ""));
            return;
        }
        robot_.joints.push_back(std::move(joint));
        unused_.push_back(unused);
    }

    int linkAt(const XMLElement& joint, const char* end) const {
        const XMLElement* link = joint.FirstChildElement(end);
        if (!link) throw InputError(placeOf(file_, joint), std::string("expected an element <") + end + ">");
        const auto found = index_.find(textOf(*link, "link"));
        if (found == index_.end())
            throw InputError(placeOf(file_, *link),
                             "expected the name of a link, found \"" + textOf(*link, "link") + "\"");
        return found->second;
    }

    Dof readDof(const XMLElement& element, RobotJoint& joint) const {
        const std::string type = textOf(element, "type");
        Dof dof;
        dof.kind = type == "prismatic" ? DofKind::Translation : DofKind::Rotation;
        dof.axis = Vec3::UnitX();
        dof.lower = dof.upper = 0;
        if (const XMLElement* axis = element.FirstChildElement("axis"))
            dof.axis = vectorOf(numbers(*axis, "xyz", 3), Vec3::UnitX());
        if (dof.axis.norm() != 1) dof.axis.normalize();
        if (const XMLElement* limit = element.FirstChildElement("limit")) {
            dof.lower = number(*limit, "lower", 0);
            dof.upper = number(*limit, "upper", 0);
        }
        if (type == "continuous") {
            dof.lower = -std::numbers::pi;
            dof.upper = std::numbers::pi;
            joint.endless = true;
        }
        if (const XMLElement* mimic = element.FirstChildElement("mimic")) {
            joint.leader = textOf(*mimic, "joint");
            joint.factor = number(*mimic, "multiplier", 1);
            joint.offset = number(*mimic, "offset", 0);
        }
        return dof;
    }

    void checkJoint(const XMLElement& joint, const std::string& type) const {
        static const std::set<std::string> types = {"revolute", "continuous", "prismatic",
                                                    "fixed",    "floating",   "planar"};
        if (!types.contains(type))
            throw InputError(placeOf(file_, joint),
                             "type: expected revolute, continuous, prismatic, fixed, floating or planar, "
                             "found \"" +
                                 type + "\"");
        if (type == "fixed") return;
        if (!joint.FirstChildElement("limit") && (type == "revolute" || type == "prismatic"))
            throw InputError(placeOf(file_, joint), "expected an element <limit lower=... upper=...>");
        if (const XMLElement* axis = joint.FirstChildElement("axis"))
            if (!(vectorOf(numbers(*axis, "xyz", 3), Vec3::UnitX()).norm() > 0))
                throw InputError(placeOf(file_, *axis), "expected an axis that is not zero");
        if (const XMLElement* mimic = joint.FirstChildElement("mimic")) expectAttributes(*mimic, {"joint"});
    }

    /// Where its joints are at 0.
    void placeLinks() {
        std::vector<const RobotJoint*> above(robot_.links.size(), nullptr);
        for (const RobotJoint& joint : robot_.joints) above[joint.child] = &joint;
        for (std::size_t k = 0; k < above.size(); ++k)
            for (const RobotJoint* joint = above[k]; joint; joint = above[joint->parent])
                robot_.links[k].place = joint->origin * robot_.links[k].place;
    }

    void leaveOut() {
        std::vector<RobotJoint> kept;
        for (std::size_t k = 0; k < robot_.joints.size(); ++k) {
            RobotJoint& joint = robot_.joints[k];
            if (unused_[k].empty())
                kept.push_back(std::move(joint));
            else
                robot_.notes.push_back(
                    leftOutJoint(joint.name, joint.where, unused_[k], robot_.links[joint.child].name));
        }
        robot_.joints = std::move(kept);
    }

    const XMLElement& top_;
    const std::string file_;
    Robot& robot_;
    std::map<std::string, int> index_;
    std::vector<std::string> unused_; ///< of each joint
};

} // namespace

Robot readUrdf(const std::string& text, const std::string& file) {
    const auto document = parseXml(text, file, "robot");
    Robot robot;
    robot.file = file;
    UrdfReader(*document->RootElement(), file, robot);
    settleRobot(robot);
    return robot;
}

void readSrdf(Robot& robot, const std::string& text, const std::string& file) {
    const auto document = parseXml(text, file, "robot");
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(robot.links, [&](const RobotLink& link) { return link.name == name; });
    };
    const XMLElement& top = *document->RootElement();
    if (top.FirstChildElement("link"))
        throw InputError(placeOf(file, *top.FirstChildElement("link")),
                         "expected an SRDF, found a URDF's <link>");
    if (const std::string name = textOf(top, "name"); name != robot.name)
        robot.notes.push_back(file + " is that of a robot \"" + name + "\", not of \"" + robot.name + "\"");
    for (auto* e = top.FirstChildElement("disable_collisions"); e;
         e = e->NextSiblingElement("disable_collisions")) {
        const std::string a = textOf(*e, "link1"), b = textOf(*e, "link2");
        if (a.empty() || b.empty())
            throw InputError(placeOf(file, *e), "expected the attributes link1 and link2");
        if (!has(a) || !has(b))
            robot.notes.push_back(file + ": " + placeOf(file, *e).pointer + ": the robot has no link \"" +
                                  (has(a) ? b : a) + "\"");
        else
            robot.unpaired.emplace_back(a, b);
    }
}

} // namespace tss
