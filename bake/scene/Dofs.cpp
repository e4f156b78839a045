#include "bake/motion/DofUnits.h"
#include "bake/scene/DofToken.h"
#include "bake/scene/SceneParts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace tss {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

constexpr Attribute dofOrder =
    declared("uniform token[] tss:dofOrder", "order of the DOFs in T(q), all that are free: `rotX` ... "
                                             "`transZ`, `path0`, ...; else slides before turns, X before Z");
constexpr Attribute dofNames = declared("uniform token[] tss:dofNames", "other names for them");
constexpr Attribute dofScale =
    declared("uniform double[] tss:dofScale", "distance of one unit of a slide's value; not 0, 1 for turns "
                                              "and paths. Limits and drives of the file stay distances");
constexpr Attribute restOfDofs =
    declared("uniform double[] tss:rest",
             "value of each DOF where the joint rests: motions start there, and what overlaps there is "
             "excepted (0, or the limit nearest to it). It must meet limits and planes. Where the bodies "
             "stand at which value the joint's frames say");
constexpr Attribute pathNumbers =
    declared("uniform double[] tss:paths", "rows of value, x, y, z, and a quaternion w, x, y, z, in the "
                                           "joint's frame; linear and slerp between rows");
constexpr Attribute pathRows = declared("uniform int[] tss:pathRows", "rows of each path", between(2, 1e7));
constexpr Attribute pathLimits =
    declared("uniform double2[] tss:pathLimits", "limits of each path within its values (all of them)");
constexpr Attribute pathDrive = declared("double tss:drive:path0", "desired value of a path");

using Paths = std::vector<std::vector<PathRow>>;

/// The names that a DOF's limits and desired motion have, and the distance of one unit of its value.
struct DofSlots {
    std::string token, low, high, drive, driveApi;
    double scale = 1;

    DofSlots(const std::string& type, const std::string& token, double scale) : token(token), scale(scale) {
        const bool turns = type == "PhysicsRevoluteJoint", alone = turns || type == "PhysicsPrismaticJoint";
        const std::string instance = !alone ? token : turns ? "angular" : "linear";
        low = alone ? schema::lowerLimit.name : "limit:" + token + ":physics:low";
        high = alone ? schema::upperLimit.name : "limit:" + token + ":physics:high";
        drive = token.starts_with("path") ? "tss:drive:" + token
                                          : "drive:" + instance + ":physics:targetPosition";
        driveApi = "PhysicsDriveAPI:" + instance;
    }
    Attribute lowest() const { return {low, "float"}; }
    Attribute highest() const { return {high, "float"}; }
    Attribute driven() const { return {drive, token.starts_with("path") ? "double" : "float"}; }

    /// Between the units of the file, degrees and distance, and the DOF's own.
    double read(const Dof& dof, double value) const {
        return dof.kind == DofKind::Rotation ? toRadians(value) : value / scale;
    }
    double written(const Dof& dof, double value) const {
        return dof.kind == DofKind::Rotation ? toDegrees(value) : value * scale;
    }
};

bool isLocked(const PrimReader& prim, const char* token) {
    if (!hasApi(prim.prim(), std::string("PhysicsLimitAPI:") + token)) return false;
    const DofSlots slots(prim.prim().typeName, token, 1);
    return prim.limit(slots.lowest(), -unlimited) > prim.limit(slots.highest(), unlimited);
}

/// The DOFs of the prim's schema that are free, in the order used when none is stated.
std::vector<std::string> freeTokens(const PrimReader& prim) {
    const std::string& type = prim.prim().typeName;
    const std::string axis = prim.choice(schema::axis);
    if (type == "PhysicsRevoluteJoint") return {"rot" + axis};
    if (type == "PhysicsPrismaticJoint") return {"trans" + axis};
    std::vector<std::string> tokens;
    if (type == "PhysicsFixedJoint") return tokens;
    for (const char* token : dofTokens) {
        if (type == "PhysicsSphericalJoint" && token[0] == 't') continue;
        if (!isLocked(prim, token)) tokens.push_back(token);
    }
    return tokens;
}

/// tss:dofOrder, checked against what the joint leaves free; paths come on top, last where no order is given.
std::vector<std::string> readOrder(const PrimReader& prim) {
    auto free = freeTokens(prim);
    if (!prim.value(dofOrder)) {
        Attribute rows = pathRows;
        rows.range = anyNumber; // told where the paths are read
        const std::size_t paths = prim.reals(rows).size();
        for (std::size_t k = 0; k < paths; ++k) free.push_back("path" + std::to_string(k));
        return free;
    }
    auto order = prim.texts(dofOrder);
    std::set<std::string> seen;
    for (const std::string& token : order) {
        Dof dof;
        std::size_t path = 0;
        if (!dofFromToken(token, dof, path))
            prim.problem(dofOrder, "expected rotX ... rotZ, transX ... transZ or path0, path1, ..., found \"",
                         token, "\"");
        else if (!seen.insert(token).second)
            prim.problem(dofOrder, "expected each DOF once, found \"", token, "\" again");
        else if (dof.kind != DofKind::Path && std::ranges::find(free, token) == free.end())
            prim.problem(dofOrder, "expected DOFs that the joint leaves free, found \"", token,
                         "\", which is locked");
        else
            continue;
        return free;
    }
    for (const std::string& token : free)
        if (!seen.contains(token)) {
            prim.problem(dofOrder, "expected all DOFs that the joint leaves free; \"", token,
                         "\" is missing");
            return free;
        }
    return order;
}

/// The cone of a spherical joint is read as a box that holds it, the angles about the two axes across: as the
/// twist is free, either of them takes up the other's, so that both go as far as the wider. A cone of a right
/// angle and more is none, nor is one whose twist comes between the other two turns, as about Y where no
/// order is given, or that a path is part of: no box holds it.
void readCone(const PrimReader& prim, const std::string& token, const std::vector<std::string>& order,
              Dof& dof) {
    const std::string twist = "rot" + prim.choice(schema::axis);
    const bool held = std::ranges::all_of(order, [](const auto& turn) { return turn.starts_with("rot"); }) &&
                      !(order.size() == 3 && order[1] == twist);
    const double cone0 = prim.real(schema::coneAngle0, -1), cone1 = prim.real(schema::coneAngle1, -1);
    const double cone = std::max(cone0, cone1);
    const bool limited = token != twist && held && cone0 >= 0 && cone1 >= 0 && cone < 90;
    dof.lower = toRadians(limited ? -cone : -180);
    dof.upper = toRadians(limited ? cone : 180);
}

void readLimits(const PrimReader& prim, const DofSlots& slots, const std::vector<std::string>& order,
                Dof& dof) {
    if (prim.prim().typeName == "PhysicsSphericalJoint" &&
        !hasApi(prim.prim(), "PhysicsLimitAPI:" + slots.token))
        return readCone(prim, slots.token, order, dof);
    double lower = prim.limit(slots.lowest(), -unlimited), upper = prim.limit(slots.highest(), unlimited);
    if (lower > upper) {
        prim.problem(slots.highest(), "expected at least the lower limit ", lower, ", found ", upper);
        upper = lower;
    }
    dof.lower = slots.read(dof, lower);
    dof.upper = slots.read(dof, upper);
    if (dof.lower > dof.upper) std::swap(dof.lower, dof.upper); // a negative scale
}

void writeLimits(PrimWriter& prim, const Dof& dof, const DofSlots& slots) {
    double low = slots.written(dof, dof.lower), high = slots.written(dof, dof.upper);
    if (low > high) std::swap(low, high);
    if (std::isfinite(low)) prim.set(slots.lowest(), Value(low));
    if (std::isfinite(high)) prim.set(slots.highest(), Value(high));
    if (slots.low != schema::lowerLimit.name) addApi(prim.prim(), "PhysicsLimitAPI:" + slots.token);
}

void lockTheRest(PrimWriter& prim, const std::vector<DofSlots>& free) {
    for (const char* token : dofTokens) {
        if (std::ranges::any_of(free, [&](const DofSlots& slots) { return slots.token == token; })) continue;
        addApi(prim.prim(), std::string("PhysicsLimitAPI:") + token);
        const DofSlots locked("PhysicsJoint", token, 1);
        prim.set(locked.lowest(), Value(1.0));
        prim.set(locked.highest(), Value(-1.0));
    }
}

/// Of unit length; one that is so but for rounding stays as it is, so that what was read and written is read
/// as the same again.
Eigen::Quaterniond unitTurn(const Eigen::Quaterniond& turn) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    return std::abs(turn.squaredNorm() - 1) <= rounding ? turn : turn.normalized();
}

/// The rows of all paths: value, translation, quaternion w x y z.
Paths readPaths(const PrimReader& prim) {
    Paths paths;
    const auto counts = prim.reals(pathRows);
    double total = 0;
    for (double count : counts) total += count;
    const auto numbers = prim.reals(pathNumbers, static_cast<std::size_t>(8 * total));
    if (numbers.size() != 8 * total) {
        if (!prim.has(pathNumbers)) prim.problem(pathNumbers, "expected the rows that tss:pathRows counts");
        return paths;
    }
    const double* row = numbers.data();
    for (double count : counts) {
        std::vector<PathRow>& path = paths.emplace_back();
        for (int k = 0; k < count; ++k, row += 8) {
            const auto index = (row - numbers.data()) / 8;
            const Eigen::Quaterniond turn(row[4], row[5], row[6], row[7]);
            if (!(std::abs(turn.norm() - 1) < 1e-3))
                prim.problem(pathNumbers,
                             "expected rows of value, translation and a quaternion w, x, y, z of length 1, "
                             "found one of length ",
                             turn.norm(), " in row ", index);
            if (k > 0 && !(row[0] > path.back().value))
                prim.problem(pathNumbers, "expected rising values, found ", row[0], " in row ", index);
            path.push_back({row[0], Vec3(row[1], row[2], row[3]), unitTurn(turn)});
        }
    }
    return paths;
}

void readPath(const PrimReader& prim, const Paths& paths, std::size_t which, Dof& dof) {
    if (which >= paths.size())
        return prim.problem(dofOrder, "expected a path of tss:paths, found path", which, " of ",
                            paths.size());
    dof.path = paths[which];
    dof.lower = dof.path.front().value;
    dof.upper = dof.path.back().value;
    const auto limits = prim.reals(pathLimits, 2 * paths.size());
    if (limits.empty()) return;
    const double low = limits[2 * which], high = limits[2 * which + 1];
    if (low < dof.lower || high > dof.upper || low > high)
        return prim.problem(pathLimits, "expected lower and upper limits within the path's own values");
    dof.lower = low;
    dof.upper = high;
}

void writePaths(PrimWriter& prim, const Joint& joint) {
    std::vector<double> rows, counts, limits;
    bool limited = false;
    for (const Dof& dof : joint.dofs) {
        if (dof.kind != DofKind::Path) continue;
        counts.push_back(static_cast<double>(dof.path.size()));
        for (const PathRow& row : dof.path)
            rows.insert(rows.end(), {row.value, row.translation.x(), row.translation.y(), row.translation.z(),
                                     row.rotation.w(), row.rotation.x(), row.rotation.y(), row.rotation.z()});
        limits.insert(limits.end(), {dof.lower, dof.upper});
        limited = limited || dof.path.empty() || dof.lower != dof.path.front().value ||
                  dof.upper != dof.path.back().value;
    }
    if (counts.empty()) return;
    prim.set(pathNumbers, rows);
    prim.set(pathRows, counts);
    if (limited) prim.set(pathLimits, Value(Numbers{limits, 2}));
}

/// One number per DOF, or the fallback for each when the attribute is absent.
std::vector<double> onePerDof(const PrimReader& prim, const Attribute& attribute, std::size_t count,
                              double fallback) {
    auto numbers = prim.reals(attribute, count);
    if (numbers.size() != count) numbers.assign(count, fallback);
    return numbers;
}

std::vector<double> readScales(const PrimReader& prim, const std::vector<std::string>& order) {
    auto scales = onePerDof(prim, dofScale, order.size(), 1);
    for (std::size_t k = 0; k < scales.size(); ++k) {
        const bool slides = order[k].starts_with("trans");
        if (slides ? scales[k] != 0 : scales[k] == 1) continue;
        if (slides)
            prim.problem(dofScale, "expected scales that are not 0");
        else
            prim.problem(dofScale, "expected a scale of 1 for \"", order[k], "\"");
        scales[k] = 1;
    }
    return scales;
}

/// Where no rest is given it is the value nearest to 0 that the limits leave. One that is given is moved to a
/// limit only where it is beyond by the rounding of the file's floats; those of a path are doubles.
double restWithin(const Dof& dof, double rest, bool given) {
    if (!(dof.lower <= dof.upper)) return rest;
    const double within = std::clamp(rest, dof.lower, dof.upper);
    const double rounding = std::ldexp(std::abs(within), dof.kind == DofKind::Path ? -50 : -22);
    return !given || std::abs(rest - within) <= rounding ? within : rest;
}

/// Along which axis of the joint's frame the DOF lies; throws when along none.
int axisOf(const Dof& dof, const std::string& path) {
    for (int k = 0; k < 3; ++k) {
        const double along = dof.axis[k];
        const bool only = along != 0 && dof.axis == Vec3::Unit(k) * along;
        const bool centred = dof.origin == Vec3::Unit(k) * dof.origin[k];
        if (dof.kind == DofKind::Translation ? only : only && along == 1 && centred) return k;
    }
    throw InputError({"", "", path},
                     "expected rotations about and translations along X, Y or Z of the joint's frame");
}

std::vector<DofSlots> spell(const Joint& joint) {
    std::vector<DofSlots> slots;
    std::set<std::string> seen;
    int paths = 0;
    for (const Dof& dof : joint.dofs) {
        std::string token;
        double scale = 1;
        if (dof.kind == DofKind::Path) {
            if (!dof.frame.matrix().isIdentity(0))
                throw InputError({"", "", joint.path}, "expected a path in the joint's own frame");
            token = "path" + std::to_string(paths++);
        } else {
            const int axis = axisOf(dof, joint.path);
            token = dofTokens[axis + (dof.kind == DofKind::Rotation ? 3 : 0)];
            if (dof.kind == DofKind::Translation) scale = dof.axis[axis];
        }
        if (!seen.insert(token).second)
            throw InputError({"", "", joint.path},
                             "expected each DOF of a joint once, found " + token + " again: use two joints");
        slots.emplace_back(jointType(joint), token, scale);
    }
    return slots;
}

/// What of ours a joint needs beyond USD's own attributes; nothing for an ordinary hinge or slide.
void writeOurs(PrimWriter& prim, const Joint& joint, const std::vector<DofSlots>& slots) {
    std::vector<std::string> tokens, names;
    std::vector<double> scales, rests;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        const Dof& dof = joint.dofs[k];
        tokens.push_back(slots[k].token);
        names.push_back(dof.name.empty() ? slots[k].token : dof.name);
        scales.push_back(slots[k].scale);
        rests.push_back(toUser(dof, dof.rest));
    }
    const auto all = [](const std::vector<double>& values, double value) {
        return std::ranges::all_of(values, [&](double v) { return v == value; });
    };
    if (jointType(joint) == "PhysicsJoint") prim.set(dofOrder, tokens);
    if (names != tokens) prim.set(dofNames, names);
    if (!all(scales, 1)) prim.set(dofScale, scales);
    if (!all(rests, 0)) prim.set(restOfDofs, rests);
    writePaths(prim, joint);
    writePlanes(prim, joint);
}

} // namespace

void readDofs(const PrimReader& prim, Joint& joint) {
    const auto order = readOrder(prim);
    const auto scales = readScales(prim, order);
    const auto isPath = [](const std::string& token) { return token.starts_with("path"); };
    const auto paths = std::ranges::any_of(order, isPath) ? readPaths(prim) : Paths();
    const auto rests = onePerDof(prim, restOfDofs, order.size(), 0);
    auto names = prim.texts(dofNames);
    if (prim.has(dofNames) && names.size() != order.size())
        prim.problem(dofNames, "expected ", order.size(), " names, one a DOF, found ", names.size());
    if (names.size() != order.size()) names = order;
    for (std::size_t k = 0; k < order.size(); ++k) {
        Dof dof;
        std::size_t path = 0;
        dofFromToken(order[k], dof, path);
        const DofSlots slots(prim.prim().typeName, order[k], scales[k]);
        if (dof.kind == DofKind::Path)
            readPath(prim, paths, path, dof);
        else
            readLimits(prim, slots, order, dof);
        dof.name = names[k];
        dof.rest = restWithin(dof, fromUser(dof, rests[k]), prim.has(restOfDofs));
        TimeSamples& drive = joint.drives.emplace_back(prim.samples(slots.driven()));
        for (double& value : drive.values) value = slots.read(dof, value);
        if (dof.kind == DofKind::Translation) dof.axis *= scales[k];
        joint.dofs.push_back(std::move(dof));
    }
    readPlanes(prim, joint);
}

void writeDofs(PrimWriter& prim, const Joint& joint) {
    const auto slots = spell(joint);
    const bool alone = jointType(joint) != "PhysicsJoint";
    if (alone && !slots.empty())
        prim.setUnless(schema::axis, slots[0].token.substr(slots[0].token.size() - 1), "X");
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        const Dof& dof = joint.dofs[k];
        if (dof.kind != DofKind::Path) writeLimits(prim, dof, slots[k]);
        if (k >= joint.drives.size() || joint.drives[k].empty()) continue;
        TimeSamples drive = joint.drives[k];
        for (double& value : drive.values) value = slots[k].written(dof, value);
        if (dof.kind != DofKind::Path) addApi(prim.prim(), slots[k].driveApi);
        prim.set(slots[k].driven(), drive);
    }
    if (!alone) lockTheRest(prim, slots);
    writeOurs(prim, joint, slots);
}

SchemaType dofSchema() {
    return {"PhysicsJoint",
            {dofOrder, dofNames, dofScale, restOfDofs, pathNumbers, pathRows, pathLimits, pathDrive}};
}

} // namespace tss
