#include "bake/robot/UrdfText.h"

#include "bake/robot/Xml.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>

namespace tss {

using tinyxml2::XMLElement;

namespace {

/// What an element may hold that is read, and how many numbers its attributes are.
struct Kept {
    std::set<std::string_view> children;
    std::vector<std::pair<const char*, std::size_t>> numbers;
};

const std::map<std::string_view, Kept>& keptElements() {
    static const std::map<std::string_view, Kept> kept = {
        {"robot", {{"link", "joint", "material"}, {}}},
        {"link", {{"visual", "collision"}, {}}},
        {"visual", {{"origin", "geometry", "material"}, {}}},
        {"collision", {{"origin", "geometry"}, {}}},
        {"geometry", {{"box", "cylinder", "sphere", "mesh", "capsule"}, {}}},
        {"joint", {{"parent", "child", "origin", "axis", "limit", "mimic"}, {}}},
        {"material", {{"color"}, {}}},
        {"color", {}},
        {"origin", {{}, {{"xyz", 3}, {"rpy", 3}}}},
        {"parent", {}},
        {"child", {}},
        {"axis", {{}, {{"xyz", 3}}}},
        {"limit", {{}, {{"lower", 1}, {"upper", 1}}}},
        {"mimic", {{}, {{"multiplier", 1}, {"offset", 1}}}},
        {"box", {{}, {{"size", 3}}}},
        {"cylinder", {{}, {{"radius", 1}, {"length", 1}}}},
        {"sphere", {{}, {{"radius", 1}}}},
        {"capsule", {{}, {{"radius", 1}, {"length", 1}}}},
        {"mesh", {{}, {{"scale", 3}}}},
    };
    return kept;
}

void expectAttributes(const std::string& file, const XMLElement& element,
                      std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (textOf(element, name).empty())
            throw InputError(placeOf(file, element), std::string("expected an attribute ") + name);
}

/// The numbers as urdfdom reads them, whatever they were written like.
void spellNumbers(const std::string& file, XMLElement& element, const Kept& kept) {
    for (const auto& [attribute, count] : kept.numbers) {
        std::string text;
        for (double number : numbersOf(file, element, attribute, count, count))
            text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", number);
        if (!text.empty()) element.SetAttribute(attribute, text.c_str());
    }
}

/// The turn of URDF 1.1's quat_xyzw as the rpy of all versions.
void spellTurn(const std::string& file, XMLElement& origin) {
    const auto q = numbersOf(file, origin, "quat_xyzw", 4, 4);
    if (q.empty()) return;
    if (origin.Attribute("rpy"))
        throw InputError(placeOf(file, origin), "expected one of rpy and quat_xyzw, found both");
    const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
    if (!(quaternion.norm() > 0))
        throw InputError(placeOf(file, origin), "quat_xyzw: expected one that is not zero");
    const Eigen::Matrix3d turn = quaternion.normalized().toRotationMatrix();
    const double across = std::hypot(turn(2, 1), turn(2, 2));
    const bool upright = across < 1e-9; // turned about z and about x is the same then
    const double roll = upright ? 0 : std::atan2(turn(2, 1), turn(2, 2)),
                 pitch = std::atan2(-turn(2, 0), across),
                 yaw = upright ? std::atan2(-turn(0, 1), turn(1, 1)) : std::atan2(turn(1, 0), turn(0, 0));
    origin.SetAttribute("rpy", fmt::format("{:.17g} {:.17g} {:.17g}", roll, pitch, yaw).c_str());
    origin.DeleteAttribute("quat_xyzw");
}

/// Keeps what is read of the element and of what is in it.
void prune(XMLElement& element, const std::string& file) {
    if (element.Name() == std::string_view("origin")) spellTurn(file, element);
    const Kept& kept = keptElements().at(element.Name());
    spellNumbers(file, element, kept);
    for (tinyxml2::XMLNode *child = element.FirstChild(), *next = nullptr; child; child = next) {
        next = child->NextSibling();
        XMLElement* inner = child->ToElement();
        if (inner && kept.children.contains(inner->Name()))
            prune(*inner, file);
        else
            element.DeleteChild(child);
    }
}

/// The one shape of a visual or collision, which has what its kind needs; null where there is none.
const XMLElement* shapeOf(const std::string& file, const XMLElement& item) {
    const XMLElement* geometry = item.FirstChildElement("geometry");
    if (geometry && geometry->NextSiblingElement("geometry"))
        throw InputError(placeOf(file, item), "expected one <geometry>");
    const XMLElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
    if (!shape) return nullptr;
    if (shape->NextSiblingElement())
        throw InputError(placeOf(file, *shape->NextSiblingElement()), "expected one shape in a <geometry>");
    const std::string_view kind = shape->Name();
    if (kind == "box") expectAttributes(file, *shape, {"size"});
    if (kind == "cylinder" || kind == "capsule") expectAttributes(file, *shape, {"radius", "length"});
    if (kind == "sphere") expectAttributes(file, *shape, {"radius"});
    if (kind == "mesh") expectAttributes(file, *shape, {"filename"});
    return shape;
}

double numberOf(const std::string& file, const XMLElement& element, const char* attribute) {
    return numbersOf(file, element, attribute, 1, 1).at(0);
}

/// A capsule, as Bullet and Drake have it; urdfdom does not know it.
RobotShape capsuleOf(const std::string& file, const XMLElement& item, const XMLElement& capsule) {
    RobotShape shape;
    shape.kind = RobotShape::Kind::Capsule;
    shape.size = {numberOf(file, capsule, "radius"), numberOf(file, capsule, "length"), 0};
    shape.where = placeOf(file, capsule).pointer;
    const XMLElement* origin = item.FirstChildElement("origin");
    if (!origin) return shape;
    const auto at = numbersOf(file, *origin, "xyz", 3, 3), rpy = numbersOf(file, *origin, "rpy", 3, 3);
    if (!at.empty()) shape.place.translation() = Vec3(at[0], at[1], at[2]);
    if (!rpy.empty())
        shape.place.linear() =
            (Eigen::AngleAxisd(rpy[2], Vec3::UnitZ()) * Eigen::AngleAxisd(rpy[1], Vec3::UnitY()) *
             Eigen::AngleAxisd(rpy[0], Vec3::UnitX()))
                .toRotationMatrix();
    return shape;
}

/// Leaves those visuals and collisions of a link that urdfdom reads.
void pruneShapes(const std::string& file, XMLElement& link, std::vector<OwnShape>& own) {
    for (XMLElement *item = link.FirstChildElement(), *next = nullptr; item; item = next) {
        next = item->NextSiblingElement();
        const bool visual = item->Name() == std::string_view("visual");
        if (!visual && item->Name() != std::string_view("collision")) continue;
        OwnShape mine{textOf(link, "name"), visual, {}};
        try {
            const XMLElement* geometry = item->FirstChildElement("geometry");
            for (auto* shape = geometry ? geometry->FirstChildElement() : nullptr; shape;
                 shape = shape->NextSiblingElement())
                if (!keptElements().at("geometry").children.contains(shape->Name()))
                    throw InputError(placeOf(file, *shape),
                                     std::string("a shape <") + shape->Name() + "> is none of URDF's");
            prune(*item, file);
            const XMLElement* shape = shapeOf(file, *item);
            if (shape && shape->Name() != std::string_view("capsule")) continue;
            if (shape) own.push_back({mine.link, visual, capsuleOf(file, *item, *shape)});
        } catch (const InputError& error) {
            mine.shape.where = error.where.pointer;
            mine.shape.problem = error.message;
            own.push_back(mine);
        }
        link.DeleteChild(item);
    }
}

void checkJoint(const std::string& file, const std::set<std::string>& links, const XMLElement& joint) {
    static const std::set<std::string> types = {"revolute", "continuous", "prismatic",
                                                "fixed",    "floating",   "planar"};
    const std::string type = textOf(joint, "type");
    for (const char* end : {"parent", "child"}) {
        const XMLElement* link = joint.FirstChildElement(end);
        if (!link) throw InputError(placeOf(file, joint), std::string("expected an element <") + end + ">");
        const std::string name = textOf(*link, "link");
        if (!links.contains(name))
            throw InputError(placeOf(file, *link), "expected the name of a link, found \"" + name + "\"");
    }
    if (!types.contains(type))
        throw InputError(
            placeOf(file, joint),
            "type: expected revolute, continuous, prismatic, fixed, floating or planar, found \"" + type +
                "\"");
    if (!joint.FirstChildElement("limit") && (type == "revolute" || type == "prismatic"))
        throw InputError(placeOf(file, joint), "expected an element <limit lower=... upper=...>");
    if (const XMLElement* axis = joint.FirstChildElement("axis")) {
        const auto along = numbersOf(file, *axis, "xyz", 3, 3);
        if (!along.empty() && Vec3(along[0], along[1], along[2]).isZero(0))
            throw InputError(placeOf(file, *axis), "expected an axis that is not zero");
    }
    if (const XMLElement* mimic = joint.FirstChildElement("mimic")) expectAttributes(file, *mimic, {"joint"});
}

/// Leaves those joints that can be read; says of the others why not.
void pruneJoints(const std::string& file, XMLElement& robot, const std::set<std::string>& links,
                 std::vector<std::string>& notes) {
    for (XMLElement *joint = robot.FirstChildElement("joint"), *next = nullptr; joint; joint = next) {
        next = joint->NextSiblingElement("joint");
        try {
            // What a fixed joint has no use for, exporters write all the same, as an axis of zeros.
            if (textOf(*joint, "type") == "fixed")
                for (const char* unused : {"axis", "limit", "mimic"})
                    while (XMLElement* element = joint->FirstChildElement(unused))
                        joint->DeleteChild(element);
            prune(*joint, file);
            checkJoint(file, links, *joint);
            // Neither is used, and many files leave them out, which urdfdom does not let pass.
            if (XMLElement* limit = joint->FirstChildElement("limit"))
                for (const char* unused : {"effort", "velocity"}) limit->SetAttribute(unused, "0");
        } catch (const InputError& error) {
            const XMLElement* child = joint->FirstChildElement("child");
            const std::string name = child ? textOf(*child, "link") : "";
            notes.push_back(leftOutJoint(textOf(*joint, "name"), error.where.pointer,
                                         "cannot be read (" + error.message + ")",
                                         links.contains(name) ? name : ""));
            robot.DeleteChild(joint);
        }
    }
}

/// The links that no joint holds, in their order.
std::vector<std::string> rootsOf(const XMLElement& robot) {
    std::set<std::string> held;
    for (auto* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint"))
        if (const XMLElement* child = joint->FirstChildElement("child")) held.insert(textOf(*child, "link"));
    std::vector<std::string> roots;
    for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
        if (!held.contains(textOf(*link, "name"))) roots.push_back(textOf(*link, "name"));
    return roots;
}

/// urdfdom wants one root: where there are several they are held by one more.
void joinRoots(XMLElement& robot) {
    const std::vector<std::string> roots = rootsOf(robot);
    if (roots.size() < 2) return;
    std::set<std::string> taken;
    for (auto* e = robot.FirstChildElement(); e; e = e->NextSiblingElement())
        taken.insert(textOf(*e, "name"));
    std::string prefix = "root";
    while (std::ranges::any_of(taken, [&](const std::string& name) { return name.starts_with(prefix); }))
        prefix += "_";
    robot.InsertNewChildElement("link")->SetAttribute("name", prefix.c_str());
    for (const std::string& root : roots) {
        XMLElement* joint = robot.InsertNewChildElement("joint");
        joint->SetAttribute("name", (prefix + root).c_str());
        joint->SetAttribute("type", "fixed");
        joint->InsertNewChildElement("parent")->SetAttribute("link", prefix.c_str());
        joint->InsertNewChildElement("child")->SetAttribute("link", root.c_str());
    }
}

std::set<std::string> expectOnce(const std::string& file, XMLElement& robot, const char* kind) {
    std::set<std::string> seen;
    for (auto* e = robot.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
        expectAttributes(file, *e, {"name"});
        if (!seen.insert(textOf(*e, "name")).second)
            throw InputError(placeOf(file, *e),
                             std::string("expected a name that no other ") + kind + " has");
    }
    return seen;
}

} // namespace

std::string leftOutJoint(const std::string& joint, const std::string& where, const std::string& why,
                         const std::string& child) {
    const std::string left = "joint " + joint + " (" + where + ") " + why + ": left out";
    return child.empty() ? left : left + ", " + child + " and what hangs on it are tied to nothing";
}

PrunedUrdf pruneUrdf(XMLElement& robot, const std::string& file) {
    PrunedUrdf pruned;
    const std::string version = textOf(robot, "version", "1.0");
    static const std::set<std::string> known = {"1", "1.0", "1.1", "1.2"};
    if (!known.contains(version))
        throw InputError(placeOf(file, robot),
                         "version: expected 1.0, 1.1 or 1.2, found \"" + version + "\"");
    if (textOf(robot, "name").empty()) robot.SetAttribute("name", std::filesystem::path(file).stem().c_str());
    const std::set<std::string> links = expectOnce(file, robot, "link");
    expectOnce(file, robot, "joint");
    if (links.empty()) throw InputError(placeOf(file, robot), "expected at least one <link>");
    for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
        pruneShapes(file, *link, pruned.shapes);
    const std::vector<std::string> roots = rootsOf(robot);
    for (std::size_t k = 1; k < roots.size(); ++k)
        pruned.notes.push_back("link " + roots[k] +
                               " hangs on no joint: tied to nothing, as is what hangs on it");
    pruneJoints(file, robot, links, pruned.notes);
    prune(robot, file); // what is neither
    return pruned;
}

std::string urdfText(const XMLElement& robot) {
    tinyxml2::XMLDocument document;
    tinyxml2::XMLNode* top = document.InsertEndChild(robot.ShallowClone(&document));
    top->ToElement()->DeleteAttribute("version"); // what 1.1 adds is spelled in words of 1.0, 1.2 adds rates
    for (const auto* child = robot.FirstChildElement(); child; child = child->NextSiblingElement())
        if (child->Name() != std::string_view("material")) top->InsertEndChild(child->DeepClone(&document));
    for (auto* link = top->FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
        for (auto* visual = link->FirstChildElement("visual"); visual;
             visual = visual->NextSiblingElement("visual"))
            while (auto* material = visual->FirstChildElement("material")) visual->DeleteChild(material);
    joinRoots(*top->ToElement());
    tinyxml2::XMLPrinter printer(nullptr, true);
    document.Print(&printer);
    return printer.CStr();
}

std::optional<Vec3> urdfColor(const std::string& file, const XMLElement& link) {
    const auto linear = [](double c) { return std::pow(std::min(1.0, std::max(0.0, c)), 2.2); };
    for (auto* visual = link.FirstChildElement("visual"); visual;
         visual = visual->NextSiblingElement("visual")) {
        const XMLElement* material = visual->FirstChildElement("material");
        if (!material) continue;
        const std::string name = textOf(*material, "name");
        const XMLElement* color = material->FirstChildElement("color");
        const XMLElement* robot = link.Parent()->ToElement();
        for (auto* m = robot->FirstChildElement("material"); m && !color;
             m = m->NextSiblingElement("material"))
            if (textOf(*m, "name") == name) color = m->FirstChildElement("color");
        if (!color) continue;
        try {
            const auto rgba = numbersOf(file, *color, "rgba", 4, 4);
            if (!rgba.empty()) return Vec3(linear(rgba[0]), linear(rgba[1]), linear(rgba[2]));
        } catch (const InputError&) { // no collision depends on it
        }
    }
    return std::nullopt;
}

} // namespace tss
