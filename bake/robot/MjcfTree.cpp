#include "bake/robot/MjcfTree.h"

#include "bake/motion/SmallSystems.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

namespace tss {

using tinyxml2::XMLElement;

namespace {

constexpr std::size_t mostFiles = 64, mostBytesInAll = 8 << 20, mostElementsInAll = 100000,
                      mostClasses = 10000;
constexpr std::size_t longestDefault = 200; ///< characters: a default is copied to each element of its class

/// What says how an element stands in place of its quat. MuJoCo keeps both, and this counts, also where a
/// class has it and the element a quat of its own.
const std::set<std::string> turns = {"axisangle", "xyaxes", "zaxis", "euler"};

class Includer {
public:
    Includer(const std::string& file, const ReadOther& readOther) : file_(file), readOther_(readOther) {}

    void include(XMLElement& parent) {
        for (XMLElement *child = parent.FirstChildElement(), *next = nullptr; child; child = next) {
            next = child->NextSiblingElement();
            if (child->Name() != std::string_view("include")) {
                include(*child);
                continue;
            }
            XMLElement* first = insert(*child);
            parent.DeleteChild(child);
            if (first) next = first; // an included file may include
        }
    }

    std::list<XmlFile> files;

private:
    /// Puts the content behind the element; the first of it.
    XMLElement* insert(XMLElement& element) {
        const std::string name = textOf(element, "file");
        if (name.empty()) throw InputError(placeOf(file_, element), "expected an attribute file");
        if (!seen_.insert(name).second)
            throw InputError(placeOf(file_, element),
                             "expected each file to be included once, found " + name + " again");
        std::string text;
        try {
            text = readOther_(name);
        } catch (const InputError& error) {
            throw InputError(placeOf(file_, element), error.what()); // with the file that it is about
        }
        bytes_ += text.size();
        if (seen_.size() > mostFiles || bytes_ > mostBytesInAll)
            throw InputError(placeOf(file_, element),
                             "expected no more than 64 included files of 8 MiB together");
        files.push_back({name, parseXml(text, name, "")});
        return insertCopies(element, files.back());
    }

    std::string file_;
    const ReadOther& readOther_;
    std::set<std::string> seen_;
    std::size_t bytes_ = 0;
};

std::size_t countElements(const XMLElement& parent) {
    std::size_t count = 1;
    for (auto* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) count += countElements(*e);
    return count;
}

using Attributes = std::map<std::string, std::string>;

/// Of the kinds of elements that have classes and are read.
using ClassDefaults = std::map<std::string, Attributes>;

/// What an element keeps of its class: that which is read.
const std::map<std::string, std::set<std::string>>& read() {
    static const std::map<std::string, std::set<std::string>> names = {
        {"geom",
         {"type", "contype", "conaffinity", "size", "fromto", "pos", "quat", "axisangle", "xyaxes", "zaxis",
          "euler", "mesh", "rgba"}},
        {"joint", {"type", "pos", "axis", "range", "limited", "ref"}},
        {"mesh", {"scale", "refpos", "refquat"}}};
    return names;
}

/// A size of fewer numbers than that of the class leaves the class's others as they are.
std::string wholeSize(const std::string& own, const std::string& ofClass) {
    std::istringstream said(own), others(ofClass);
    std::string word, skipped, whole = own;
    while (said >> word) others >> skipped;
    while (others >> word) whole += " " + word;
    return whole;
}

class Defaults {
public:
    Defaults(XMLElement& model, const std::string& file) : file_(file) {
        classes_["main"];
        // Those at the top are all one class, that of elements without any, whatever it is called.
        for (auto* e = model.FirstChildElement("default"); e; e = e->NextSiblingElement("default")) {
            readClass(*e, "main", classes_["main"]);
            if (e->Attribute("class")) classes_[textOf(*e, "class")] = classes_["main"];
        }
        for (auto* e = model.FirstChildElement("asset"); e; e = e->NextSiblingElement("asset"))
            apply(*e, "main");
        for (auto* e = model.FirstChildElement("worldbody"); e; e = e->NextSiblingElement("worldbody"))
            apply(*e, "main");
    }

private:
    void readClass(const XMLElement& element, const std::string& name, ClassDefaults defaults) {
        if (name.empty()) throw InputError(placeOf(file_, element), "expected an attribute class");
        for (auto* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const auto kind = read().find(e->Name());
            if (kind == read().end()) continue;
            for (const auto* a = e->FirstAttribute(); a; a = a->Next())
                if (kind->second.contains(a->Name())) {
                    std::string& value = defaults[e->Name()][a->Name()];
                    value = a->Name() == std::string_view("size") ? wholeSize(checked(*e, *a), value)
                                                                  : checked(*e, *a);
                }
        }
        classes_[name] = defaults;
        if (classes_.size() > mostClasses)
            throw InputError(placeOf(file_, element), "expected no more than 10000 default classes");
        for (auto* e = element.FirstChildElement("default"); e; e = e->NextSiblingElement("default"))
            readClass(*e, textOf(*e, "class"), defaults);
    }

    std::string checked(const XMLElement& element, const tinyxml2::XMLAttribute& attribute) const {
        const std::string value = attribute.Value();
        if (value.size() > longestDefault)
            throw InputError(placeOf(file_, element),
                             std::string(attribute.Name()) + ": expected no more than 200 characters");
        return value;
    }

    const ClassDefaults& classCalled(const XMLElement& element, const std::string& name) const {
        const auto at = classes_.find(name);
        if (at == classes_.end())
            throw InputError(placeOf(file_, element),
                             "expected the name of a default class, found \"" + name + "\"");
        return at->second;
    }

    void apply(XMLElement& parent, const std::string& childClass) {
        for (XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const std::string name = e->Name();
            if (name == "body" || name == "frame" || name == "replicate") {
                apply(*e, textOf(*e, "childclass", childClass));
                continue;
            }
            if (!read().contains(name)) continue;
            const ClassDefaults& defaults = classCalled(*e, textOf(*e, "class", childClass));
            const auto own = defaults.find(name);
            if (own == defaults.end()) continue;
            const bool turned = std::ranges::any_of(
                turns, [&](const std::string& turn) { return e->Attribute(turn.c_str()); });
            for (const auto& [attribute, value] : own->second) {
                const char* said = e->Attribute(attribute.c_str());
                if (said && attribute == "size")
                    e->SetAttribute("size", wholeSize(said, value).c_str());
                else if (!said && !(turned && turns.contains(attribute)))
                    e->SetAttribute(attribute.c_str(), value.c_str());
            }
        }
    }

    std::string file_;
    std::map<std::string, ClassDefaults> classes_;
};

Eigen::Quaterniond eulerTurn(const std::vector<double>& angles, const MjcfCompiler& compiler) {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    for (int k = 0; k < 3; ++k) {
        const char axis = compiler.eulerOrder[k];
        const Eigen::Quaterniond one(Eigen::AngleAxisd(
            compiler.angle(angles[k]), Vec3::Unit(std::tolower(static_cast<unsigned char>(axis)) - 'x')));
        turn = std::islower(static_cast<unsigned char>(axis)) ? turn * one : one * turn;
    }
    return turn;
}

/// The rotation with these directions for X and, nearly, Y.
Eigen::Quaterniond axesTurn(const Vec3& x, const Vec3& y) {
    Eigen::Matrix3d axes;
    axes.col(0) = x.normalized();
    axes.col(1) = (y - axes.col(0).dot(y) * axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return Eigen::Quaterniond(axes);
}

} // namespace

Eigen::Quaterniond turnOfZ(const Vec3& z) {
    // Of opposite directions MuJoCo turns about x.
    if (z.z() < 0 && z.head<2>().norm() < 1e-10 * z.norm()) return {0, 1, 0, 0};
    return turnBetween(Vec3::UnitZ(), z);
}

double MjcfCompiler::angle(double value) const {
    return degrees ? value * std::numbers::pi / 180 : value;
}

std::list<XmlFile> includeAll(XMLElement& model, const std::string& file, const ReadOther& readOther) {
    Includer includer(file, readOther);
    includer.include(model);
    if (countElements(model) > mostElementsInAll)
        throw InputError(Where{file}, "expected no more than 100000 elements with what is included");
    return std::move(includer.files);
}

MjcfCompiler readCompiler(const XMLElement& model, const std::string& file) {
    MjcfCompiler compiler;
    for (auto* e = model.FirstChildElement("compiler"); e; e = e->NextSiblingElement("compiler")) {
        const auto expect = [&](const char* attribute, std::initializer_list<const char*> words,
                                const char* hint = "") {
            const std::string text = textOf(*e, attribute);
            if (!text.empty() && std::ranges::none_of(words, [&](const char* w) { return text == w; }))
                throw InputError(placeOf(file, *e), std::string(attribute) + ": expected " + *words.begin() +
                                                        ", found \"" + text + "\"" + hint);
            return text;
        };
        if (const std::string unit = expect("angle", {"degree", "radian"}); !unit.empty())
            compiler.degrees = unit == "degree";
        if (const std::string limits = expect("autolimits", {"true", "false"}); !limits.empty())
            compiler.autoLimits = limits == "true";
        compiler.stripPath = compiler.stripPath || expect("strippath", {"true", "false"}) == "true";
        expect("coordinate", {"local"}, "; MuJoCo up to 2.3.3 makes it so: load the model there and save it");
        compiler.meshFolder = textOf(*e, "meshdir", textOf(*e, "assetdir", compiler.meshFolder));
        if (const std::string order = textOf(*e, "eulerseq"); !order.empty()) {
            if (order.size() != 3 || order.find_first_not_of("xyzXYZ") != order.npos)
                throw InputError(placeOf(file, *e),
                                 "eulerseq: expected three of x, y, z, X, Y, Z, found \"" + order + "\"");
            compiler.eulerOrder = order;
        }
    }
    return compiler;
}

void applyDefaults(XMLElement& model, const std::string& file) {
    Defaults(model, file);
}

Pose placeOfElement(const XMLElement& element, const std::string& file, const MjcfCompiler& compiler) {
    const auto vector = [](const std::vector<double>& n, std::size_t at = 0) {
        return Vec3(n[at], n[at + 1], n[at + 2]);
    };
    const auto given = [&](const char* attribute, std::size_t count) {
        return numbersOf(file, element, attribute, count, count);
    };
    const auto nonZero = [&](const Vec3& axis) {
        if (!(axis.norm() > 0))
            throw InputError(placeOf(file, element), "expected directions that are not zero");
        return axis;
    };
    Pose pose = Pose::Identity();
    if (const auto pos = given("pos", 3); !pos.empty()) pose.translation() = vector(pos);
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    if (const auto a = given("axisangle", 4); !a.empty()) {
        turn = Eigen::AngleAxisd(compiler.angle(a[3]), nonZero(vector(a)).normalized());
    } else if (const auto xy = given("xyaxes", 6); !xy.empty()) {
        nonZero(vector(xy).cross(vector(xy, 3)));
        turn = axesTurn(vector(xy), vector(xy, 3));
    } else if (const auto z = given("zaxis", 3); !z.empty()) {
        turn = turnOfZ(nonZero(vector(z)));
    } else if (const auto e = given("euler", 3); !e.empty()) {
        turn = eulerTurn(e, compiler);
    } else if (const auto q = given("quat", 4); !q.empty()) {
        turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
        if (!(turn.norm() > 0))
            throw InputError(placeOf(file, element), "quat: expected one that is not zero");
        turn.normalize();
    }
    if (turn.vec() != Vec3::Zero()) pose.linear() = turn.toRotationMatrix(); // exact where it turns nothing
    return pose;
}

} // namespace tss
