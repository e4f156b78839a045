#include "bake/usd/UsdRobot.h"

#include "bake/usd/UsdParts.h"
#include "bake/usd/UsdSkel.h"

#include <algorithm>
#include <set>

namespace tss {

namespace {

constexpr Attribute rigidEnabled{"physics:rigidBodyEnabled", "bool"},
    kinematic{"physics:kinematicEnabled", "bool"}, approximation{"physics:approximation", "token", true};

/// Empty also for what is no path, which is said where the joint is read.
std::string bodyPathOf(const PrimReader& joint, const Attribute& body) {
    try {
        return joint.target(body);
    } catch (const InputError&) {
        return "";
    }
}

class Reader {
public:
    Reader(const UsdStage& stage, const std::string& file)
        : problems_(file), reading_(stage.layer, problems_), entries_(reading_.index.entries),
          colliders_(reading_), world_(worldXforms(reading_, &unplaced_)) {
        robot_.file = file;
        robot_.notes = stage.notes;
    }

    Robot read() {
        readMetadata();
        findLinks();
        skel_ = readUsdSkel(reading_, {world_, unplaced_, linkOf_}, robot_.startTimeCode, names_, leftOut_);
        placeGprims();
        noteOthers();
        addWorld();
        readUsdJoints(
            reading_, [this](const PrimReader& prim, const std::string& path) { return endOf(prim, path); },
            worldLink_, robot_, leftOut_);
        tieToWorld();
        readFilteredPairs();
        restAsShown(robot_, leftOut_);
        addCharacters(skel_, worldLink_, reading_.layer.metadata.contains("endTimeCode"), robot_, leftOut_);
        if (robot_.links.empty()) {
            std::string found;
            for (const auto& notes : {robot_.notes, leftOut_.notes()})
                for (const std::string& note : notes) found += "; " + note;
            throw InputError(Where{robot_.file},
                             "expected at least one rigid body, collider or mesh, found none" + found);
        }
        for (const std::string& note : leftOut_.notes()) robot_.notes.push_back(note);
        settleRobot(robot_);
        return std::move(robot_);
    }

private:
    PrimReader reader(std::size_t entry) const { return reading_.reader(static_cast<int>(entry)); }
    const std::string& pathOf(std::size_t entry) const { return entries_[entry].place.path; }

    double number(const char* key, double fallback) const {
        const double* value = member<double>(reading_.layer.metadata, key);
        return value ? *value : fallback;
    }

    void readMetadata() {
        const Value::Object& metadata = reading_.layer.metadata;
        robot_.metersPerUnit = number("metersPerUnit", 0.01);
        if (!(robot_.metersPerUnit > 0 && robot_.metersPerUnit < 1e30))
            throw InputError(Where{robot_.file}, "metersPerUnit: expected a number above 0");
        if (!metadata.contains("metersPerUnit"))
            robot_.notes.push_back("the file has no metersPerUnit: one unit is a centimetre, as in USD");
        const auto up = metadata.find("upAxis");
        robot_.upAxis = up != metadata.end() && up->second == Value("Z") ? 'Z' : 'Y';
        if (const auto* name = member<std::string>(metadata, "defaultPrim")) robot_.name = *name;
        if (robot_.name.empty() && !reading_.layer.children.empty())
            robot_.name = reading_.layer.children.front().name;
        robot_.timeCodesPerSecond = number("timeCodesPerSecond", 24);
        robot_.startTimeCode = number("startTimeCode", 0);
        robot_.endTimeCode = std::max(number("endTimeCode", 0), robot_.startTimeCode);
        if (!(robot_.timeCodesPerSecond > 0)) robot_.timeCodesPerSecond = 24;
    }

    bool isRigid(std::size_t entry) const {
        return hasApi(*entries_[entry].prim, "PhysicsRigidBodyAPI") && reader(entry).flag(rigidEnabled, true);
    }

    int addLink(const std::string& path, const Eigen::Affine3d& world) {
        constexpr std::size_t most = 500;
        if (robot_.links.size() >= most)
            throw InputError(Where{robot_.file, "", path},
                             "expected no more than 500 bodies; of many robots a layer that references one");
        RobotLink link;
        link.name = freeName(path, names_);
        link.place = split({world, false}).placement;
        robot_.links.push_back(std::move(link));
        return static_cast<int>(robot_.links.size()) - 1;
    }

    /// One without a place stands at the origin, without what it has below it, and no joint ties it.
    int addPlacedLink(std::size_t entry) {
        if (unplaced_[entry].empty()) return addLink(pathOf(entry), world_[entry].matrix);
        leftOut_.add("left out: bodies without a place, of which neither shapes nor joints can be had",
                     pathOf(entry) + " (" + unplaced_[entry] + ")");
        return addLink(pathOf(entry), Eigen::Affine3d::Identity());
    }

    void expectPlaced(std::size_t entry) const {
        if (!unplaced_[entry].empty()) problems_.add(entries_[entry].place, unplaced_[entry]);
    }

    /// Rigid bodies, and prims of none that a joint ties a body to.
    void findLinks() {
        const std::size_t count = entries_.size();
        linkOf_.assign(count, -1);
        std::vector<bool> holdsBodies(count), starts(count);
        for (std::size_t i = 0; i < count; ++i) {
            starts[i] = isRigid(i);
            if (starts[i])
                for (int at = entries_[i].parent; at >= 0 && !holdsBodies[at]; at = entries_[at].parent)
                    holdsBodies[at] = true;
        }
        rigid_ = starts;
        for (std::size_t i = 0; i < count; ++i) {
            if (!isJoint(*entries_[i].prim)) continue;
            for (const Attribute& body : {schema::body0, schema::body1}) {
                const std::string path = bodyPathOf(reader(i), body);
                int at = path.empty() ? -1 : reading_.index.find(path);
                if (at < 0 || holdsBodies[at]) continue;
                bool within = false;
                for (int above = at; above >= 0; above = entries_[above].parent)
                    within = within || starts[above];
                if (!within) starts[at] = true;
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            const int parent = entries_[i].parent;
            if (starts[i])
                linkOf_[i] = addPlacedLink(i), fixed_.push_back(!rigid_[i]);
            else if (parent >= 0 && !isJoint(*entries_[i].prim))
                linkOf_[i] = linkOf_[parent];
        }
    }

    /// Each gprim to its link; what none has becomes part of the world.
    void placeGprims() {
        bool physics = !robot_.links.empty(), shapes = false;
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            physics = physics || colliders_.is(i);
            shapes = shapes || (isGprim(*entries_[i].prim) && !skel_.skinned[i]);
        }
        if (!physics && shapes)
            leftOut_.add("no rigid bodies and no colliders: each mesh is a body of its own", robot_.name);
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const Prim& prim = *entries_[i].prim;
            remark(i);
            if (colliders_.isPrototype(i) || skel_.skinned[i]) continue;
            const bool collider = colliders_.collides(i);
            int link = linkOf_[i];
            if (!isGprim(prim)) {
                addUnread(i, link, collider);
                continue;
            }
            if (link < 0 && physics && !collider) {
                leftOut_.add("left out: " + prim.typeName +
                                 "s that belong to no rigid body and collide with nothing",
                             pathOf(i));
                continue;
            }
            if (link < 0 && !physics && !unplaced_[i].empty()) {
                leftOut_.add("left out: meshes without a place", unplaced_[i]);
                continue;
            }
            if (link < 0 && !physics) link = addLink(pathOf(i), world_[i].matrix), fixed_.push_back(false);
            addShape(i, link, collider || !physics);
        }
    }

    /// In one note, since there are many of them that have no part in this: looks, lights, a simulator's own.
    void noteOthers() {
        std::vector<std::string> types;
        for (const auto& [type, paths] : others_) types.push_back(type + " (" + firstOf(paths, 1) + ")");
        if (!types.empty())
            robot_.notes.push_back("left out: prims of other types: " + firstOf(types, types.size()));
    }

    /// A shape that cannot be had: of the rest of its link alone nothing can be proven. The world does
    /// without planes.
    void addUnread(std::size_t entry, int link, bool collider) {
        const Prim& prim = *entries_[entry].prim;
        const bool own = colliders_.is(entry) && !isGroup(prim) && colliders_.collides(entry);
        if (!own && !isUnreadSurface(prim)) return;
        collider =
            collider || (prim.typeName == "PointInstancer" && colliders_.hasCollidingPrototypes(entry));
        if (link < 0 && (!collider || prim.typeName == "Plane")) return;
        RobotShape shape;
        shape.where = pathOf(entry);
        shape.problem = "a shape of type " + prim.typeName + " is not read";
        RobotLink& to = link >= 0 ? robot_.links[link] : scenery_;
        (collider ? to.collision : to.visual).push_back(std::move(shape));
    }

    void addShape(std::size_t entry, int link, bool collider) {
        Eigen::Affine3d place = world_[entry].matrix;
        if (link >= 0) place = Eigen::Affine3d(robot_.links[link].place.inverse(Eigen::Isometry)) * place;
        const PrimReader prim = reader(entry);
        RobotShape shape;
        shape.where = pathOf(entry);
        try {
            if (!unplaced_[entry].empty()) throw InputError(unplaced_[entry]);
            shape.mesh = std::make_shared<const TriangleMesh>(meshOfGprim(prim, place));
        } catch (const InputError& error) {
            shape.problem = messageBelow(shape.where, error);
        }
        if (shape.mesh && shape.mesh->empty())
            return leftOut_.add("left out: meshes without faces", pathOf(entry));
        RobotLink& to = link >= 0 ? robot_.links[link] : scenery_;
        if (const auto colors = prim.vectors(schema::displayColor); !colors.empty() && !to.color)
            to.color = colors.front().cwiseMax(0).cwiseMin(1);
        (collider ? to.collision : to.visual).push_back(std::move(shape));
    }

    /// What is in the prim and is not read, or read otherwise.
    void remark(std::size_t entry) {
        const Prim& prim = *entries_[entry].prim;
        const std::string& type = prim.typeName;
        if (!isGroup(prim) && !isGprim(prim) && type.find("Joint") == type.npos) {
            if (colliders_.is(entry))
                leftOut_.add("left out: colliders of type " + type, pathOf(entry));
            else if (type != "PhysicsCollisionGroup" && !isOfCharacters(type)) // which are read elsewhere
                others_[type].push_back(pathOf(entry));
        }
        if (colliders_.is(entry) && isGroup(prim))
            leftOut_.add("colliders that are no gprims themselves: all that is below them collides",
                         pathOf(entry));
        if (const Property* how = prim.property(approximation.name);
            how && how->defaultValue && *how->defaultValue != Value("none"))
            leftOut_.add("meshes that others collide as " + describe(*how->defaultValue) +
                             ", taken as they are",
                         pathOf(entry));
        const Property* scheme = prim.property(schema::subdivisionScheme.name);
        if (type == "Mesh" && !(scheme && scheme->defaultValue && *scheme->defaultValue == Value("none")))
            leftOut_.add(
                "meshes whose surface USD subdivides (no subdivisionScheme \"none\"), taken as they are",
                pathOf(entry));
        if (const Property* holes = prim.property("holeIndices");
            type == "Mesh" && holes && holes->defaultValue && *holes->defaultValue != Value(Value::Array()))
            leftOut_.add(
                "faces that are holes (holeIndices), taken as surface: what is proven holds, contact "
                "may be reported in them",
                pathOf(entry));
        for (const auto& [name, property] : prim.properties)
            if (!property.timeSamples.empty() && (name.starts_with("xformOp:") || name == "points")) {
                leftOut_.add(
                    "left out: animation of places and points; the default counts, or the first sample",
                    pathOf(entry));
                break;
            }
        if (hasApi(prim, "PhysicsArticulationRootAPI") || hasApi(prim, "PhysicsMassAPI"))
            leftOut_.add("not read: masses and articulations' settings", pathOf(entry));
    }

    /// The link of all that stands still, if there is any need for it.
    void addWorld() {
        if (scenery_.collision.empty() && scenery_.visual.empty()) return;
        scenery_.name = "world";
        while (!names_.insert(scenery_.name).second) scenery_.name += "_";
        worldLink_ = static_cast<int>(robot_.links.size());
        robot_.links.push_back(std::move(scenery_));
        fixed_.push_back(false);
    }

    JointEnd endOf(const PrimReader& prim, const std::string& path) {
        JointEnd end;
        end.link = worldLink_;
        if (path.empty()) return end;
        const int entry = reading_.index.find(path);
        if (entry < 0) {
            prim.problem("expected the paths of bodies that are there, found \"" + path + "\"");
            return end;
        }
        expectPlaced(entry);
        if (linkOf_[entry] >= 0) end.link = linkOf_[entry];
        const Pose place = end.link >= 0 ? robot_.links[end.link].place : Pose::Identity();
        end.points = Eigen::Affine3d(place.inverse(Eigen::Isometry)) * world_[entry].matrix;
        end.turn = place.linear().transpose() * split(world_[entry]).placement.linear();
        int body = entry;
        while (body >= 0 && !rigid_[body]) body = entries_[body].parent;
        end.simulated = body >= 0 && !reader(body).flag(kinematic, false);
        end.kinematic = body >= 0 && !end.simulated;
        return end;
    }

    /// What no joint holds and stands still hangs on the world; the rest is free, and said.
    void tieToWorld() {
        std::vector<bool> held(robot_.links.size());
        std::size_t onWorld = 0;
        for (const RobotJoint& joint : robot_.joints) {
            held[joint.child] = true;
            onWorld += joint.parent == worldLink_;
        }
        std::size_t still = 0;
        for (std::size_t k = 0; k < held.size(); ++k) still += fixed_[k] && !held[k];
        const bool several = still + onWorld > 1 || worldLink_ >= 0;
        std::vector<std::string> free;
        for (std::size_t k = 0; k < held.size(); ++k) {
            if (held[k] || static_cast<int>(k) == worldLink_) continue;
            if (!fixed_[k]) {
                free.push_back(robot_.links[k].name);
            } else if (several) {
                RobotJoint joint;
                joint.name = robot_.links[k].name + "_still";
                joint.parent = worldLink_;
                joint.child = static_cast<int>(k);
                joint.origin = robot_.links[k].place;
                robot_.joints.push_back(std::move(joint));
            }
        }
        const bool tied = worldLink_ >= 0 || still + onWorld > 0;
        for (const std::string& name : free)
            if (free.size() > 1 || tied)
                leftOut_.add("free bodies, which are in no pair but with what hangs on them", name);
    }

    void readFilteredPairs() {
        const FilteredLinks filtered = filteredLinks(reading_, colliders_, linkOf_, leftOut_);
        const auto nameOf = [&](int link) {
            return link >= 0 ? robot_.links[link].name : worldLink_ < 0 ? "" : robot_.links[worldLink_].name;
        };
        for (const auto& [a, b] : filtered.wholly) robot_.unpaired.emplace_back(nameOf(a), nameOf(b));
        for (const auto& [a, b] : filtered.partly)
            leftOut_.add("bodies of which some shapes alone are filtered, so that their pair stays on",
                         nameOf(a) + " and " + nameOf(b));
    }

    mutable Problems problems_;
    SceneReading reading_;
    const std::vector<PrimEntry>& entries_;
    Colliders colliders_;
    std::vector<std::string> unplaced_; ///< by entry: why it has no place; empty where it has
    std::vector<Xform> world_;
    Robot robot_;
    LeftOut leftOut_;
    UsdCharacters skel_;
    std::map<std::string, std::vector<std::string>> others_; ///< prims of types that are not read, by type
    RobotLink scenery_;
    int worldLink_ = -1;
    std::vector<int> linkOf_;         ///< by entry: its link, or that of a prim above it
    std::vector<bool> rigid_, fixed_; ///< by entry; by link: stands still unless a joint moves it
    std::set<std::string> names_;
};

void remarkUnused(const std::vector<Prim>& prims, const std::string& parent, LeftOut& leftOut) {
    for (const Prim& prim : prims) {
        const std::string path = parent + "/" + prim.name;
        const auto active = prim.metadata.find("active");
        if (active != prim.metadata.end() && active->second == Value(false))
            leftOut.add("left out: prims that are not active", path);
        else if (prim.specifier == "over")
            leftOut.add("left out: overs of prims that are nowhere defined", path);
        else if (prim.specifier == "def")
            remarkUnused(prim.children, path, leftOut);
    }
}

} // namespace

std::string messageBelow(const std::string& prim, const InputError& error) {
    const std::string& path = error.where.path;
    return (path.starts_with(prim + ".") ? path.substr(prim.size() + 1) + ": " : "") + error.message;
}

Robot robotOf(UsdStage stage, const std::string& file) {
    try {
        LeftOut unused;
        adaptTypes(stage.layer, unused);
        remarkUnused(stage.layer.children, "", unused);
        Robot robot = Reader(stage, file).read();
        for (const std::string& note : unused.notes()) robot.notes.push_back(note);
        return robot;
    } catch (const InputError& error) { // JSON pointers say nothing of a text that is none
        if (!error.where.pointer.starts_with('/')) throw;
        throw InputError(Where{error.where.file, "", error.where.path}, error.message);
    }
}

} // namespace tss
