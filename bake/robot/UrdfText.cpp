#include "bake/robot/UrdfText.h"

#include "bake/robot/Xml.h"

#include <cmath>
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
        {"geometry", {{"box", "cylinder", "sphere", "mesh"}, {}}},
        {"joint", {{"parent", "child", "origin", "axis", "limit", "mimic"}, {}}},
        {"material", {{"color"}, {}}},
        {"color", {{}, {{"rgba", 4}}}},
        {"origin", {{}, {{"xyz", 3}, {"rpy", 3}}}},
        {"parent", {}},
        {"child", {}},
        {"axis", {{}, {{"xyz", 3}}}},
        {"limit", {{}, {{"lower", 1}, {"upper", 1}}}},
        {"mimic", {{}, {{"multiplier", 1}, {"offset", 1}}}},
        {"box", {{}, {{"size", 3}}}},
        {"cylinder", {{}, {{"radius", 1}, {"length", 1}}}},
        {"sphere", {{}, {{"radius", 1}}}},
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
        for (double number : numbersOf(file, element, attribute, count, count)) {
            char digits[40];
            std::snprintf(digits, sizeof digits, "%s%.17g", text.empty() ? "" : " ", number);
            text += digits;
        }
        if (!text.empty()) element.SetAttribute(attribute, text.c_str());
    }
}

LostShape lostShape(const std::string& file, const XMLElement& geometry, const XMLElement& element) {
    const XMLElement& item = *geometry.Parent()->ToElement();
    LostShape lost{
        textOf(*item.Parent()->ToElement(), "name"), item.Name() == std::string_view("visual"), {}};
    lost.shape.where = placeOf(file, element).pointer;
    lost.shape.problem = std::string("a shape <") + element.Name() + "> is none of URDF's";
    return lost;
}

void prune(XMLElement& element, const std::string& file, std::vector<LostShape>& lost) {
    const Kept& kept = keptElements().at(element.Name());
    spellNumbers(file, element, kept);
    for (tinyxml2::XMLNode *child = element.FirstChild(), *next = nullptr; child; child = next) {
        next = child->NextSibling();
        XMLElement* inner = child->ToElement();
        if (inner && kept.children.contains(inner->Name())) {
            prune(*inner, file, lost);
            continue;
        }
        if (inner && element.Name() == std::string_view("geometry"))
            lost.push_back(lostShape(file, element, *inner));
        element.DeleteChild(child);
    }
}

/// Each visual and collision has one shape, and what each kind of shape needs; those without are taken out.
void checkShapes(const std::string& file, XMLElement& link) {
    for (XMLElement *item = link.FirstChildElement(), *next = nullptr; item; item = next) {
        next = item->NextSiblingElement();
        XMLElement* geometry = item->FirstChildElement("geometry");
        const XMLElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
        if (!shape) {
            link.DeleteChild(item);
            continue;
        }
        if (shape->NextSiblingElement())
            throw InputError(placeOf(file, *shape->NextSiblingElement()),
                             "expected one shape in a <geometry>");
        const std::string_view kind = shape->Name();
        if (kind == "box") expectAttributes(file, *shape, {"size"});
        if (kind == "cylinder") expectAttributes(file, *shape, {"radius", "length"});
        if (kind == "sphere") expectAttributes(file, *shape, {"radius"});
        if (kind == "mesh") expectAttributes(file, *shape, {"filename"});
    }
}

void checkJoint(const std::string& file, const std::set<std::string>& links, XMLElement& joint) {
    static const std::set<std::string> types = {"revolute", "continuous", "prismatic",
                                                "fixed",    "floating",   "planar"};
    const std::string type = textOf(joint, "type");
    if (!types.contains(type))
        throw InputError(
            placeOf(file, joint),
            "type: expected revolute, continuous, prismatic, fixed, floating or planar, found \"" + type +
                "\"");
    for (const char* end : {"parent", "child"}) {
        const XMLElement* link = joint.FirstChildElement(end);
        if (!link) throw InputError(placeOf(file, joint), std::string("expected an element <") + end + ">");
        const std::string name = textOf(*link, "link");
        if (!links.contains(name))
            throw InputError(placeOf(file, *link), "expected the name of a link, found \"" + name + "\"");
    }
    XMLElement* limit = joint.FirstChildElement("limit");
    if (!limit && (type == "revolute" || type == "prismatic"))
        throw InputError(placeOf(file, joint), "expected an element <limit lower=... upper=...>");
    if (const XMLElement* mimic = joint.FirstChildElement("mimic")) expectAttributes(file, *mimic, {"joint"});
    // Neither is used, and many files leave them out, which urdfdom does not let pass.
    if (limit)
        for (const char* unused : {"effort", "velocity"}) limit->SetAttribute(unused, "0");
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

std::vector<LostShape> pruneUrdf(XMLElement& robot, const std::string& file) {
    expectAttributes(file, robot, {"name"});
    std::vector<LostShape> lost;
    prune(robot, file, lost);
    const std::set<std::string> links = expectOnce(file, robot, "link");
    expectOnce(file, robot, "joint");
    for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
        checkShapes(file, *link);
    for (auto* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint"))
        checkJoint(file, links, *joint);
    if (!robot.FirstChildElement("link"))
        throw InputError(placeOf(file, robot), "expected at least one <link>");
    return lost;
}

std::string urdfText(const XMLElement& robot) {
    tinyxml2::XMLDocument document;
    tinyxml2::XMLNode* top = document.InsertEndChild(robot.ShallowClone(&document));
    top->ToElement()->DeleteAttribute("version"); // of the language: there is one
    for (const auto* child = robot.FirstChildElement(); child; child = child->NextSiblingElement())
        if (child->Name() != std::string_view("material")) top->InsertEndChild(child->DeepClone(&document));
    for (auto* link = top->FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
        for (auto* visual = link->FirstChildElement("visual"); visual;
             visual = visual->NextSiblingElement("visual"))
            while (auto* material = visual->FirstChildElement("material")) visual->DeleteChild(material);
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
        const auto rgba = color ? numbersOf(file, *color, "rgba", 4, 4) : std::vector<double>();
        if (rgba.size() == 4) return Vec3(linear(rgba[0]), linear(rgba[1]), linear(rgba[2]));
    }
    return std::nullopt;
}

} // namespace tss
