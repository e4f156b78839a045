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

/// What is said of a joint that is left out; `child`: the link that it holds, empty where there is none.
std::string leftOutJoint(const std::string& joint, const std::string& where, const std::string& why,
                         const std::string& child) {
    const std::string left = "joint " + joint + " (" + where + ") " + why + ": left out";
    return child.empty() ? left : left + ", " + child + " and what hangs on it are tied to nothing";
}

/// Turns about the fixed x, y and z in turn: to the bit what urdfdom makes of them.
Eigen::Quaterniond turnOf(const std::vector<double>& rpy) {
    const double phi = rpy[0] / 2, the = rpy[1] / 2, psi = rpy[2] / 2;
    const double x =
        std::sin(phi) * std::cos(the) * std::cos(psi) - std::cos(phi) * std::sin(the) * std::sin(psi);
    const double y =
        std::cos(phi) * std::sin(the) * std::cos(psi) + std::sin(phi) * std::cos(the) * std::sin(psi);
    const double z =
        std::cos(phi) * std::cos(the) * std::sin(psi) - std::sin(phi) * std::sin(the) * std::cos(psi);
    const double w =
        std::cos(phi) * std::cos(the) * std::cos(psi) + std::sin(phi) * std::sin(the) * std::sin(psi);
    const double s = std::sqrt(x * x + y * y + z * z + w * w);
    return {w / s, x / s, y / s, z / s};
}

class UrdfReader {
public:
    UrdfReader(const XMLElement& top, const std::string& file, Robot& robot)
        : top_(top), file_(file), robot_(robot) {
        checkVersion();
        robot_.name = textOf(top, "name");
        if (robot_.name.empty()) robot_.name = std::filesystem::path(file).stem().string();
        linkAt_ = namesOf("link");
        namesOf("joint");
        if (linkAt_.empty()) throw InputError(placeOf(file_, top), "expected at least one <link>");
        for (auto* e = top.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) readLink(*e);
        noteRoots();
        for (auto* e = top.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) readJoint(*e);
        checkForest(robot_);
        placeLinks();
        std::vector<RobotJoint> read;
        read.swap(robot_.joints);
        for (std::size_t j = 0; j < read.size(); ++j) keepJoint(std::move(read[j]), types_[j]);
    }

private:
    void checkVersion() const {
        const std::string version = textOf(top_, "version", "1.0");
        static const std::set<std::string> known = {"1", "1.0", "1.1", "1.2"};
        if (!known.contains(version))
            throw InputError(placeOf(file_, top_),
                             "version: expected 1.0, 1.1 or 1.2, found \"" + version + "\"");
    }

    void expectAttribute(const XMLElement& element, const char* name) const {
        if (textOf(element, name).empty())
            throw InputError(placeOf(file_, element), std::string("expected an attribute ") + name);
    }

    /// The elements of a kind by their names, in the order of the file.
    std::map<std::string, int> namesOf(const char* kind) const {
        std::map<std::string, int> names;
        for (auto* e = top_.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
            expectAttribute(*e, "name");
            if (!names.emplace(textOf(*e, "name"), static_cast<int>(names.size())).second)
                throw InputError(placeOf(file_, *e),
                                 std::string("expected a name that no other ") + kind + " has");
        }
        return names;
    }

    std::vector<double> numbers(const XMLElement& element, const char* attribute, std::size_t count) const {
        return numbersOf(file_, element, attribute, count, count);
    }
    Vec3 vector(const XMLElement& element, const char* attribute, const Vec3& fallback) const {
        const auto n = numbers(element, attribute, 3);
        return n.empty() ? fallback : Vec3(n[0], n[1], n[2]);
    }
    double number(const XMLElement& element, const char* attribute, double fallback) const {
        const auto n = numbers(element, attribute, 1);
        return n.empty() ? fallback : n[0];
    }
    std::vector<double> needed(const XMLElement& element, const char* attribute, std::size_t count) const {
        const auto n = numbers(element, attribute, count);
        if (n.empty()) expectAttribute(element, attribute);
        return n;
    }

    /// Where the <origin> of an item puts it; quat_xyzw is of URDF 1.1.
    Pose poseOf(const XMLElement& item) const {
        Pose pose = Pose::Identity();
        const XMLElement* origin = item.FirstChildElement("origin");
        if (!origin) return pose;
        pose.translation() = vector(*origin, "xyz", Vec3::Zero());
        const auto rpy = numbers(*origin, "rpy", 3), q = numbers(*origin, "quat_xyzw", 4);
        if (!rpy.empty() && !q.empty())
            throw InputError(placeOf(file_, *origin), "expected one of rpy and quat_xyzw, found both");
        Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
        if (!q.empty()) {
            turn = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
            if (!(turn.norm() > 0))
                throw InputError(placeOf(file_, *origin), "quat_xyzw: expected one that is not zero");
        }
        if (!rpy.empty()) turn = turnOf(rpy);
        // Exact where it turns nothing.
        if (turn.vec() != Vec3::Zero()) pose.linear() = turn.normalized().toRotationMatrix();
        return pose;
    }

    /// The one shape of a visual or collision; null where there is none.
    const XMLElement* shapeIn(const XMLElement& item) const {
        static const std::set<std::string_view> kinds = {"box", "cylinder", "sphere", "mesh", "capsule"};
        const XMLElement* geometry = item.FirstChildElement("geometry");
        const XMLElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
        for (const XMLElement* e = shape; e; e = e->NextSiblingElement())
            if (!kinds.contains(e->Name()))
                throw InputError(placeOf(file_, *e),
                                 std::string("a shape <") + e->Name() + "> is none of URDF's");
        if (geometry && geometry->NextSiblingElement("geometry"))
            throw InputError(placeOf(file_, item), "expected one <geometry>");
        if (shape && shape->NextSiblingElement())
            throw InputError(placeOf(file_, *shape->NextSiblingElement()),
                             "expected one shape in a <geometry>");
        return shape;
    }

    /// A capsule is as Bullet and Drake have it.
    void readSize(const XMLElement& element, RobotShape& shape) const {
        const std::string_view kind = element.Name();
        if (kind == "box") {
            shape.kind = RobotShape::Kind::Box;
            const auto size = needed(element, "size", 3);
            shape.size = {size[0], size[1], size[2]};
        } else if (kind == "mesh") {
            expectAttribute(element, "filename");
            shape.file = textOf(element, "filename");
            shape.size = vector(element, "scale", Vec3::Ones());
        } else if (kind == "sphere") {
            shape.kind = RobotShape::Kind::Sphere;
            shape.size = {needed(element, "radius", 1)[0], 0, 0};
        } else {
            shape.kind = kind == "capsule" ? RobotShape::Kind::Capsule : RobotShape::Kind::Cylinder;
            shape.size = {needed(element, "radius", 1)[0], needed(element, "length", 1)[0], 0};
        }
    }

    /// What cannot be read is one with a problem; such and capsules come last.
    std::vector<RobotShape> readShapes(const XMLElement& link, const char* kind) const {
        std::vector<RobotShape> shapes;
        for (auto* item = link.FirstChildElement(kind); item; item = item->NextSiblingElement(kind)) {
            RobotShape shape;
            try {
                const XMLElement* element = shapeIn(*item);
                if (!element) continue;
                shape.where = placeOf(file_, *element).pointer;
                shape.place = poseOf(*item);
                readSize(*element, shape);
            } catch (const InputError& error) {
                shape = {};
                shape.where = error.where.pointer;
                shape.problem = error.message;
            }
            shapes.push_back(shape);
        }
        std::stable_partition(shapes.begin(), shapes.end(), [](const RobotShape& shape) {
            return shape.problem.empty() && shape.kind != RobotShape::Kind::Capsule;
        });
        return shapes;
    }

    /// The colour of a link's first visual that has one, linear RGB.
    std::optional<Vec3> colorOf(const XMLElement& link) const {
        const auto linear = [](double c) { return std::pow(std::clamp(c, 0.0, 1.0), 2.2); };
        for (auto* v = link.FirstChildElement("visual"); v; v = v->NextSiblingElement("visual")) {
            const XMLElement* material = v->FirstChildElement("material");
            if (!material) continue;
            const std::string name = textOf(*material, "name");
            const XMLElement* color = material->FirstChildElement("color");
            for (auto* m = top_.FirstChildElement("material"); m && !color;
                 m = m->NextSiblingElement("material"))
                if (textOf(*m, "name") == name) color = m->FirstChildElement("color");
            if (!color) continue;
            try {
                const auto rgba = numbers(*color, "rgba", 4);
                if (!rgba.empty()) return Vec3(linear(rgba[0]), linear(rgba[1]), linear(rgba[2]));
            } catch (const InputError&) { // no collision depends on it
            }
        }
        return std::nullopt;
    }

    void readLink(const XMLElement& element) {
        RobotLink& link = robot_.links.emplace_back();
        link.name = textOf(element, "name");
        link.collision = readShapes(element, "collision");
        link.visual = readShapes(element, "visual");
        link.color = colorOf(element);
    }

    /// Of the links that no joint holds only the first is tied to something.
    void noteRoots() {
        std::set<std::string> held;
        for (auto* joint = top_.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint"))
            if (const XMLElement* child = joint->FirstChildElement("child"))
                held.insert(textOf(*child, "link"));
        bool first = true;
        for (const RobotLink& link : robot_.links) {
            if (held.contains(link.name)) continue;
            if (!first)
                robot_.notes.push_back("link " + link.name +
                                       " hangs on no joint: tied to nothing, as is what hangs on it");
            first = false;
        }
    }

    int linkOf(const XMLElement& joint, const char* end) const {
        const XMLElement* link = joint.FirstChildElement(end);
        if (!link) throw InputError(placeOf(file_, joint), std::string("expected an element <") + end + ">");
        const std::string name = textOf(*link, "link");
        const auto at = linkAt_.find(name);
        if (at == linkAt_.end())
            throw InputError(placeOf(file_, *link), "expected the name of a link, found \"" + name + "\"");
        return at->second;
    }

    void readDof(const XMLElement& element, const std::string& type, RobotJoint& joint) const {
        Dof dof;
        dof.kind = type == "prismatic" ? DofKind::Translation : DofKind::Rotation;
        const XMLElement* limit = element.FirstChildElement("limit");
        if (!limit && (type == "revolute" || type == "prismatic"))
            throw InputError(placeOf(file_, element), "expected an element <limit lower=... upper=...>");
        dof.axis = Vec3::UnitX();
        if (const XMLElement* axis = element.FirstChildElement("axis")) {
            dof.axis = vector(*axis, "xyz", dof.axis);
            if (!(dof.axis.norm() > 0))
                throw InputError(placeOf(file_, *axis), "expected an axis that is not zero");
            if (dof.axis.norm() != 1) dof.axis.normalize();
        }
        if (limit) {
            dof.lower = number(*limit, "lower", 0);
            dof.upper = number(*limit, "upper", 0);
        }
        if (type == "continuous") {
            dof.lower = -std::numbers::pi;
            dof.upper = std::numbers::pi;
            joint.endless = true;
        }
        if (const XMLElement* mimic = element.FirstChildElement("mimic")) {
            joint.factor = number(*mimic, "multiplier", 1);
            joint.offset = number(*mimic, "offset", 0);
            expectAttribute(*mimic, "joint");
            joint.leader = textOf(*mimic, "joint");
        }
        joint.dofs.push_back(dof);
    }

    /// Leaves out what cannot be read, and says why.
    void readJoint(const XMLElement& element) {
        static const std::set<std::string> types = {"revolute", "continuous", "prismatic",
                                                    "fixed",    "floating",   "planar"};
        const std::string type = textOf(element, "type");
        RobotJoint joint;
        joint.name = textOf(element, "name");
        joint.where = placeOf(file_, element).pointer;
        try {
            joint.origin = poseOf(element);
            joint.parent = linkOf(element, "parent");
            joint.child = linkOf(element, "child");
            if (!types.contains(type))
                throw InputError(
                    placeOf(file_, element),
                    "type: expected revolute, continuous, prismatic, fixed, floating or planar, found \"" +
                        type + "\"");
            // What a fixed joint has no use for, exporters write all the same, as an axis of zeros.
            if (type != "fixed") readDof(element, type, joint);
        } catch (const InputError& error) {
            const XMLElement* child = element.FirstChildElement("child");
            const std::string name = child ? textOf(*child, "link") : "";
            robot_.notes.push_back(leftOutJoint(joint.name, error.where.pointer,
                                                "cannot be read (" + error.message + ")",
                                                linkAt_.contains(name) ? name : ""));
            return;
        }
        robot_.joints.push_back(std::move(joint));
        types_.push_back(type);
    }

    /// Where all joints are at 0.
    void placeLinks() {
        std::vector<const RobotJoint*> above(robot_.links.size(), nullptr);
        for (const RobotJoint& joint : robot_.joints) above[joint.child] = &joint;
        for (std::size_t k = 0; k < above.size(); ++k)
            for (const RobotJoint* at = above[k]; at; at = above[at->parent])
                robot_.links[k].place = at->origin * robot_.links[k].place;
    }

    void keepJoint(RobotJoint joint, const std::string& type) {
        const bool limited = type == "revolute" || type == "prismatic";
        const std::string why = type == "planar"     ? "is planar, without limits"
                                : type == "floating" ? "is floating, without limits"
                                : limited && joint.dofs[0].lower > joint.dofs[0].upper
                                    ? "has a lower limit above its upper one"
                                    : "";
        if (why.empty())
            robot_.joints.push_back(std::move(joint));
        else
            robot_.notes.push_back(
                leftOutJoint(joint.name, joint.where, why, robot_.links[joint.child].name));
    }

    const XMLElement& top_;
    std::string file_;
    Robot& robot_;
    std::map<std::string, int> linkAt_;
    std::vector<std::string> types_; ///< of the joints that were read
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
