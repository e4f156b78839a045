#include "bake/robot/ReadRobot.h"

#include "bake/base/Words.h"
#include "bake/motion/WholeTurn.h"
#include "bake/robot/MjcfTree.h"
#include "bake/robot/Xml.h"

#include <map>
#include <numbers>
#include <set>

namespace tss {

using tinyxml2::XMLElement;

namespace {

constexpr double pi = std::numbers::pi;

Vec3 vectorOf(const std::vector<double>& n, const Vec3& fallback = Vec3::Zero(), std::size_t at = 0) {
    return n.size() < at + 3 ? fallback : Vec3(n[at], n[at + 1], n[at + 2]);
}

/// A mesh that geoms name.
struct MeshAsset {
    std::string file;
    Vec3 scale = Vec3::Ones();
    Pose unscaled = Pose::Identity(); ///< from its reference, before the scale
};

class MjcfReader {
public:
    MjcfReader(const XMLElement& model, const std::string& file, Robot& robot)
        : file_(file), robot_(robot), compiler_(readCompiler(model, file)) {
        for (auto* e = model.FirstChildElement("asset"); e; e = e->NextSiblingElement("asset"))
            readAssets(*e);
        for (auto* e = model.FirstChildElement("contact"); e; e = e->NextSiblingElement("contact"))
            for (auto* pair = e->FirstChildElement("pair"); pair; pair = pair->NextSiblingElement("pair"))
                pairs_.emplace_back(textOf(*pair, "geom1"), textOf(*pair, "geom2"));
        for (const auto& [one, other] : pairs_) paired_.insert({one, other});
        names_.insert("world");
        std::size_t bodies = 0;
        for (auto* e = model.FirstChildElement("worldbody"); e; e = e->NextSiblingElement("worldbody"))
            bodies += countBodies(*e), nameBodies(*e);
        several_ = bodies > 1;
        world_.name = "world";
        for (auto* e = model.FirstChildElement("worldbody"); e; e = e->NextSiblingElement("worldbody"))
            readGeoms(*e, Pose::Identity(), world_);
        const bool solid = !world_.collision.empty() || !world_.visual.empty();
        if (solid) robot.links.push_back(world_);
        for (auto* e = model.FirstChildElement("worldbody"); e; e = e->NextSiblingElement("worldbody"))
            readBodies(*e, Pose::Identity(), solid ? 0 : -1);
        for (auto* e = model.FirstChildElement("contact"); e; e = e->NextSiblingElement("contact"))
            readExcludes(*e);
        noteRest(model);
    }

private:
    std::size_t countBodies(const XMLElement& parent) const {
        std::size_t count = 0;
        for (auto* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
            count += e->Name() == std::string_view("body");
            if (e->Name() == std::string_view("frame")) count += countBodies(*e);
        }
        return count;
    }

    void nameBodies(const XMLElement& parent) {
        for (auto* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const std::string_view kind = e->Name();
            const std::string name = kind == "body" ? textOf(*e, "name") : "";
            if (!name.empty() && !names_.insert(name).second)
                throw InputError(placeOf(file_, *e), "expected a name that no other body has");
            if (kind == "body" || kind == "frame") nameBodies(*e);
        }
    }

    void readAssets(const XMLElement& assets) {
        for (auto* e = assets.FirstChildElement("mesh"); e; e = e->NextSiblingElement("mesh")) {
            MeshAsset mesh;
            const std::string file = textOf(*e, "file");
            const auto slash = file.find_last_of("/\\");
            const std::string bare = slash == file.npos ? file : file.substr(slash + 1);
            const std::string name = textOf(*e, "name", bare.substr(0, bare.find_last_of('.')));
            if (file.empty()) {
                fileless_.insert(name);
                continue;
            }
            mesh.file = compiler_.stripPath ? bare : file;
            if (!compiler_.meshFolder.empty() && mesh.file[0] != '/')
                mesh.file = compiler_.meshFolder + "/" + mesh.file;
            mesh.scale = vectorOf(numbersOf(file_, *e, "scale", 3, 3), Vec3::Ones());
            Pose reference = Pose::Identity();
            reference.translation() = vectorOf(numbersOf(file_, *e, "refpos", 3, 3));
            if (const auto q = numbersOf(file_, *e, "refquat", 4, 4); !q.empty()) {
                const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
                if (!(turn.norm() > 0))
                    throw InputError(placeOf(file_, *e), "refquat: expected one that is not zero");
                reference.linear() = turn.normalized().toRotationMatrix();
            }
            mesh.unscaled = reference.inverse(Eigen::Isometry);
            meshes_[name] = mesh;
        }
    }

    void leaveOut(const std::string& kind, const std::string& name) {
        leftOut_[kind].push_back(name.empty() ? "one without a name" : name);
    }

    /// A shape between two points, its length along z, which is turned towards the first as MuJoCo does; as
    /// wide across as its first size, whatever others it has.
    void stretch(const XMLElement& element, const std::vector<double>& ends, bool twoSizes,
                 RobotShape& shape) const {
        const Vec3 from = vectorOf(ends), to = vectorOf(ends, Vec3::Zero(), 3);
        const double length = (to - from).norm();
        if (!(length > 0)) throw InputError(placeOf(file_, element), "fromto: expected two points");
        shape.place = Pose::Identity();
        shape.place.translation() = (from + to) / 2;
        shape.place.linear() = turnOfZ(from - to).toRotationMatrix();
        if (!twoSizes) shape.size[1] = shape.size[0];
        shape.size[twoSizes ? 1 : 2] = length / 2;
    }

    /// False where it is none that is read.
    bool readShape(const XMLElement& geom, bool ofWorld, RobotShape& shape) {
        static const std::map<std::string, std::pair<RobotShape::Kind, std::size_t>> kinds = {
            {"sphere", {RobotShape::Kind::Sphere, 1}},
            {"capsule", {RobotShape::Kind::Capsule, 2}},
            {"cylinder", {RobotShape::Kind::Cylinder, 2}},
            {"box", {RobotShape::Kind::Box, 3}},
            {"ellipsoid", {RobotShape::Kind::Ellipsoid, 3}},
            {"mesh", {RobotShape::Kind::Mesh, 0}},
            {"sdf", {RobotShape::Kind::Mesh, 0}}};
        const std::string type = textOf(geom, "type", "sphere"), name = textOf(geom, "name");
        const auto kind = kinds.find(type);
        shape.where = lineOf(file_, geom);
        if (ofWorld && (type == "plane" || type == "hfield"))
            return leaveOut("geoms of type " + type, name), false;
        if (kind == kinds.end() || (type == "sdf" && !geom.Attribute("mesh")))
            return shape.problem = "a geom of type " + type + " is not read", true;
        shape.kind = kind->second.first;
        shape.place = placeOfElement(geom, file_, compiler_);
        if (type == "sdf") leaveOut("sdf geoms, which are taken as the meshes that they name", name);
        if (shape.kind == RobotShape::Kind::Mesh) return readMesh(geom, shape);
        if (geom.Attribute("mesh")) return shape.problem = "a geom fitted to a mesh is not read", true;
        const std::size_t count = kind->second.second;
        const auto ends = numbersOf(file_, geom, "fromto", 6, 6);
        auto size = numbersOf(file_, geom, "size", 1, 3);
        if (size.size() < (ends.empty() ? count : 1))
            throw InputError(placeOf(file_, geom),
                             "size: expected " +
                                 (count == 1 ? "a number" : std::to_string(count) + " numbers") + " for a " +
                                 type);
        size.resize(3, 0);
        shape.size = vectorOf(size);
        if (!ends.empty() && count > 1) stretch(geom, ends, count == 2, shape);
        if (shape.kind == RobotShape::Kind::Box) shape.size *= 2; // half lengths
        if (count == 2) shape.size[1] *= 2;
        return true;
    }

    bool readMesh(const XMLElement& geom, RobotShape& shape) {
        const std::string name = textOf(geom, "mesh");
        const auto mesh = meshes_.find(name);
        if (mesh == meshes_.end()) {
            if (fileless_.contains(name)) return shape.problem = "mesh \"" + name + "\" has no file", true;
            throw InputError(placeOf(file_, geom),
                             "mesh: expected the name of a mesh of <asset>, found \"" + name + "\"");
        }
        shape.file = mesh->second.file;
        shape.size = mesh->second.scale;
        shape.unscaled = mesh->second.unscaled;
        return true;
    }

    /// Whether a replicate holds geoms of the body that it stands in.
    static bool hasGeoms(const XMLElement& replicate) {
        for (auto* e = replicate.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const std::string_view kind = e->Name();
            if (kind == "geom" || ((kind == "frame" || kind == "replicate") && hasGeoms(*e))) return true;
        }
        return false;
    }

    void readGeoms(const XMLElement& body, const Pose& place, RobotLink& link) {
        for (auto* e = body.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const std::string_view kind = e->Name();
            if (kind == "frame") readGeoms(*e, place * placeOfElement(*e, file_, compiler_), link);
            if (kind == "replicate" && hasGeoms(*e)) {
                RobotShape made;
                made.where = lineOf(file_, *e);
                made.problem = "geoms made by replicate are not read";
                link.collision.push_back(made);
                link.visual.push_back(made);
            }
            if (kind != "geom") continue;
            RobotShape shape;
            if (!readShape(*e, &link == &world_, shape)) continue;
            shape.place = place * shape.place;
            const std::string name = textOf(*e, "name");
            if (!name.empty()) bodyOf_[name] = link.name;
            const auto bits = [&](const char* attribute) {
                const auto number = numbersOf(file_, *e, attribute, 1, 1);
                return number.empty() || number[0] != 0;
            };
            const bool meets =
                bits("contype") || bits("conaffinity") || (!name.empty() && paired_.contains(name));
            if (const auto rgba = numbersOf(file_, *e, "rgba", 4, 4); !rgba.empty() && !link.color)
                link.color = Vec3(rgba[0], rgba[1], rgba[2]).cwiseMax(0).cwiseMin(1);
            (meets ? link.collision : link.visual).push_back(shape);
        }
    }

    void readBodies(const XMLElement& parent, const Pose& place, int link) {
        static const std::set<std::string_view> makers = {"replicate", "composite", "flexcomp", "attach"};
        for (auto* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const std::string_view kind = e->Name();
            if (kind == "frame") readBodies(*e, place * placeOfElement(*e, file_, compiler_), link);
            if (kind == "body") readBody(*e, place, link);
            if (makers.contains(kind))
                leaveOut("bodies made by " + std::string(kind), textOf(*e, "name", textOf(*e, "prefix")));
        }
    }

    void readBody(const XMLElement& element, const Pose& place, int parent) {
        RobotLink link;
        link.name = textOf(element, "name");
        link.named = !link.name.empty();
        if (!link.named) link.name = "body" + std::to_string(robot_.links.size());
        while (!link.named && names_.contains(link.name)) link.name += "_";
        const Pose origin = place * placeOfElement(element, file_, compiler_);
        link.place = parent < 0 ? origin : robot_.links[parent].place * origin;
        readGeoms(element, Pose::Identity(), link);
        const int index = static_cast<int>(robot_.links.size());
        robot_.links.push_back(link);
        readJoints(element, origin, parent, index);
        readBodies(element, Pose::Identity(), index);
    }

    /// The joints that a body has, in order, those inside of frames too; with the frame's place.
    void collectJoints(const XMLElement& body, const Pose& place,
                       std::vector<std::pair<const XMLElement*, Pose>>& joints) const {
        for (auto* e = body.FirstChildElement(); e; e = e->NextSiblingElement()) {
            const std::string_view kind = e->Name();
            if (kind == "joint" || kind == "freejoint") joints.emplace_back(e, place);
            if (kind == "frame") collectJoints(*e, place * placeOfElement(*e, file_, compiler_), joints);
        }
    }

    void readJoints(const XMLElement& body, const Pose& origin, int parent, int child) {
        RobotJoint joint;
        joint.parent = parent;
        joint.child = child;
        joint.origin = origin;
        joint.where = lineOf(file_, body);
        joint.name = robot_.links[child].name + "_joint";
        std::vector<std::pair<const XMLElement*, Pose>> elements;
        collectJoints(body, Pose::Identity(), elements);
        if (elements.size() == 1) joint.name = textOf(*elements[0].first, "name", joint.name);
        bool tied = textOf(body, "mocap") != "true";
        if (!tied)
            leaveOut("motion from outside (mocap): the bodies are tied to nothing", robot_.links[child].name);
        for (const auto& [element, place] : elements) tied = readDofs(*element, place, joint) && tied;
        if (!tied) return;
        // What stands on its own needs no joint to the world.
        if (joint.dofs.empty() && parent < 0 && !several_) return;
        robot_.joints.push_back(joint);
    }

    /// False where the body is not tied by it.
    bool readDofs(const XMLElement& element, const Pose& place, RobotJoint& joint) {
        const std::string body = robot_.links[joint.child].name;
        const std::string type =
            element.Name() == std::string_view("freejoint") ? "free" : textOf(element, "type", "hinge");
        Dof dof;
        dof.name = textOf(element, "name");
        dof.origin = place * vectorOf(numbersOf(file_, element, "pos", 3, 3));
        const auto range = numbersOf(file_, element, "range", 2, 2);
        const std::string limited = textOf(element, "limited", "auto");
        const bool limits = limited == "true" || (limited == "auto" && compiler_.autoLimits &&
                                                  !range.empty() && range[0] < range[1]);
        const auto untied = [&](const std::string& kind) {
            leaveOut(kind + ": the bodies are tied to nothing", body);
            return false;
        };
        if (type == "free") return untied("free joints");
        if (type != "ball" && type != "hinge" && type != "slide") return untied("joints of type " + type);
        if (limits && range.empty()) return untied("joints with limits and no range");
        if (limits && range[0] > range[1]) return untied("joints with a lower limit above their upper one");
        if (type == "ball") return addBall(limits ? compiler_.angle(range[1]) : pi, dof, joint), true;
        const Vec3 axis = place.linear() * vectorOf(numbersOf(file_, element, "axis", 3, 3), Vec3::UnitZ());
        if (axis.isZero(0)) return untied("joints whose axis is zero");
        dof.axis = axis.norm() == 1 ? axis : Vec3(axis.stableNormalized());
        const auto ref = numbersOf(file_, element, "ref", 1, 1);
        if (type == "slide") {
            dof.kind = DofKind::Translation;
            if (!limits) return untied("slides without limits");
            setLimits(dof, range[0], range[1], ref.empty() ? 0 : ref[0]);
        } else if (limits) {
            setLimits(dof, compiler_.angle(range[0]), compiler_.angle(range[1]),
                      ref.empty() ? 0 : compiler_.angle(ref[0]));
        } else {
            setWholeTurn(dof);
        }
        joint.dofs.push_back(dof);
        return true;
    }

    /// Values are counted from where the body stands as modelled, which is at `ref`.
    void setLimits(Dof& dof, double lower, double upper, double ref) {
        dof.lower = lower - ref;
        dof.upper = upper - ref;
        if (ref != 0) leaveOut("joints whose values are counted from their ref on", dof.name);
    }

    /// No turn by up to `most` has angles about x, y, z beyond these: what is turned stays within a cone
    /// about where it was.
    void addBall(double most, const Dof& about, RobotJoint& joint) {
        leaveOut("balls, which are taken as three turns about x, y, z that hold all of their own",
                 about.name);
        for (int k = 0; k < 3; ++k) {
            Dof dof = about;
            dof.name += dof.name.empty() ? "" : std::string("_") + "xyz"[k];
            dof.axis = Vec3::Unit(k);
            const double limit = most < pi / 2 ? most : k == 1 ? pi / 2 : pi;
            dof.lower = -limit;
            dof.upper = limit;
            joint.dofs.push_back(dof);
        }
    }

    void readExcludes(const XMLElement& contact) {
        std::set<std::pair<std::string, std::string>> tested; // bodies of geoms that a <pair> names
        for (const auto& [one, other] : pairs_) {
            tested.emplace(bodyOf_[one], bodyOf_[other]);
            tested.emplace(bodyOf_[other], bodyOf_[one]);
        }
        for (auto* e = contact.FirstChildElement("exclude"); e; e = e->NextSiblingElement("exclude")) {
            const std::string a = textOf(*e, "body1"), b = textOf(*e, "body2");
            if (!names_.contains(a) || !names_.contains(b))
                leaveOut("excludes of bodies that are not there", a + " and " + b);
            else if (tested.contains({a, b})) // by MuJoCo all the same
                leaveOut("excludes of bodies whose geoms a pair names", a + " and " + b);
            else
                robot_.unpaired.emplace_back(a, b);
        }
    }

    void noteRest(const XMLElement& model) {
        for (auto* e = model.FirstChildElement("equality"); e; e = e->NextSiblingElement("equality"))
            for (auto* one = e->FirstChildElement(); one; one = one->NextSiblingElement()) {
                std::string name = textOf(*one, "name");
                for (const char* of : {"joint1", "body1", "tendon1", "site1", "geom1"})
                    if (name.empty() && one->Attribute(of))
                        name = one->Name() + std::string(" of ") + textOf(*one, of);
                leaveOut("equalities (what is proven without them holds with them)",
                         name.empty() ? one->Name() : name);
            }
        for (const auto& [kind, names] : leftOut_) {
            const bool counted =
                kind.starts_with("joints whose") || kind.starts_with("balls") || kind.starts_with("sdf");
            constexpr std::size_t most = 20;
            robot_.notes.push_back((counted ? "" : "left out: ") + kind + ": " + firstOf(names, most));
        }
    }

    std::string file_;
    Robot& robot_;
    MjcfCompiler compiler_;
    RobotLink world_;
    std::map<std::string, MeshAsset> meshes_;
    std::set<std::string> names_, fileless_;
    std::vector<std::pair<std::string, std::string>> pairs_; ///< geoms that a <pair> names
    std::set<std::string> paired_;              ///< each of them: it collides whatever its own bits
    std::map<std::string, std::string> bodyOf_; ///< of geoms that have a name
    std::map<std::string, std::vector<std::string>> leftOut_; ///< names by kind
    bool several_ = false;                                    ///< bodies stand in the world beside each other
};

} // namespace

Robot readMjcf(const std::string& text, const std::string& file, const ReadOther& readOther) {
    const auto document = parseXml(text, file, "mujoco");
    XMLElement& model = *document->RootElement();
    const auto included = includeAll(model, file, readOther); // places are asked of it
    applyDefaults(model, file);
    Robot robot;
    robot.file = file;
    robot.name = textOf(model, "model", "model");
    MjcfReader(model, file, robot);
    if (robot.links.empty()) {
        std::string leftOut;
        for (const std::string& note : robot.notes) leftOut += "; " + note;
        throw InputError(Where{file}, "expected at least one <body>, found none" + leftOut);
    }
    settleRobot(robot);
    return robot;
}

} // namespace tss
