#include "bake/base/Degrees.h"
#include "bake/scene/DofToken.h"
#include "bake/scene/SceneReading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace tss {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A limit of the file, degrees or distance, in the DOF's own unit.
double inDofUnit(const Dof& dof, double value, double scale) {
    return dof.kind == DofKind::Rotation ? toRadians(value) : value / scale;
}

/// The slots of limits and of the desired motion of one DOF.
struct DofSlots {
    std::string token, low, high, drive;
};

DofSlots slotsOf(const PrimReader& prim, const std::string& token) {
    DofSlots slots{token, "limit:" + token + ":physics:low", "limit:" + token + ":physics:high",
                   "drive:" + token + ":physics:targetPosition"};
    const std::string& type = prim.prim().typeName;
    if (type == "PhysicsRevoluteJoint" || type == "PhysicsPrismaticJoint") {
        slots.low = schema::lowerLimit.name;
        slots.high = schema::upperLimit.name;
        slots.drive = type == "PhysicsRevoluteJoint" ? "drive:angular:physics:targetPosition"
                                                     : "drive:linear:physics:targetPosition";
    }
    return slots;
}

bool isLocked(const PrimReader& prim, const char* token) {
    if (!hasApi(prim.prim(), std::string("PhysicsLimitAPI:") + token)) return false;
    const DofSlots slots = slotsOf(prim, token);
    return prim.limit({slots.low.c_str(), "float"}, -unlimited) >
           prim.limit({slots.high.c_str(), "float"}, unlimited);
}

/// The DOFs of the prim's schema that are free, in the order used when none is stated.
std::vector<std::string> freeTokens(const PrimReader& prim) {
    const std::string& type = prim.prim().typeName;
    const std::string axis = prim.choice(schema::axis, {"X", "Y", "Z"});
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
    if (!prim.value(schema::dofOrder)) {
        const std::size_t paths = prim.reals(schema::pathRows).size();
        for (std::size_t k = 0; k < paths; ++k) free.push_back("path" + std::to_string(k));
        return free;
    }
    auto order = prim.texts(schema::dofOrder);
    std::set<std::string> seen;
    for (const std::string& token : order) {
        Dof dof;
        std::size_t path = 0;
        if (!dofFromToken(token, dof, path))
            prim.problem(schema::dofOrder,
                         "expected rotX ... rotZ, transX ... transZ or path0, path1, ..., found \"" + token +
                             "\"");
        else if (!seen.insert(token).second)
            prim.problem(schema::dofOrder, "expected each DOF once, found \"" + token + "\" again");
        else if (dof.kind != DofKind::Path && std::find(free.begin(), free.end(), token) == free.end())
            prim.problem(schema::dofOrder, "expected DOFs that the joint leaves free, found \"" + token +
                                               "\", which is locked");
        else
            continue;
        return free;
    }
    for (const std::string& token : free)
        if (!seen.contains(token)) {
            prim.problem(schema::dofOrder,
                         "expected all DOFs that the joint leaves free; \"" + token + "\" is missing");
            return free;
        }
    return order;
}

/// The cone of a spherical joint is read as a box: the angles about the two axes across, each within its
/// limit.
void readCone(const PrimReader& prim, const std::string& token, Dof& dof) {
    const int axis = prim.choice(schema::axis, {"X", "Y", "Z"})[0] - 'X';
    const int about = token.back() - 'X';
    double cone = -1;
    if (about == (axis + 1) % 3) cone = prim.real(schema::coneAngle0, -1);
    if (about == (axis + 2) % 3) cone = prim.real(schema::coneAngle1, -1);
    if (cone < 0) cone = 180; // no limit: all the way round
    dof.lower = toRadians(-cone);
    dof.upper = toRadians(cone);
}

void readLimits(const PrimReader& prim, const DofSlots& slots, double scale, Dof& dof) {
    if (prim.prim().typeName == "PhysicsSphericalJoint" &&
        !hasApi(prim.prim(), "PhysicsLimitAPI:" + slots.token))
        return readCone(prim, slots.token, dof);
    const Attribute low{slots.low.c_str(), "float"}, high{slots.high.c_str(), "float"};
    double lower = prim.limit(low, -unlimited), upper = prim.limit(high, unlimited);
    if (lower > upper) {
        prim.problem(high, "expected at least the lower limit " + describe(Value(lower)).substr(7) +
                               ", found " + describe(Value(upper)).substr(7));
        upper = lower;
    }
    dof.lower = inDofUnit(dof, lower, scale);
    dof.upper = inDofUnit(dof, upper, scale);
    if (dof.lower > dof.upper) std::swap(dof.lower, dof.upper); // a negative scale
}

TimeSamples readDrive(const PrimReader& prim, const DofSlots& slots, double scale, const Dof& dof) {
    const std::string ours = "tss:drive:" + slots.token;
    TimeSamples drive = dof.kind == DofKind::Path ? prim.samples({ours.c_str(), "double"})
                                                  : prim.samples({slots.drive.c_str(), "float"});
    for (double& value : drive.values) value = inDofUnit(dof, value, dof.kind == DofKind::Path ? 1 : scale);
    return drive;
}

/// The rows of all paths: value, translation, quaternion w x y z.
std::vector<std::vector<PathRow>> readPaths(const PrimReader& prim) {
    std::vector<std::vector<PathRow>> paths;
    const auto counts = prim.reals(schema::pathRows, Range{2, 1e7});
    double total = 0;
    for (double count : counts) total += count;
    const auto numbers = prim.reals(schema::paths, static_cast<std::size_t>(8 * total));
    if (numbers.size() != 8 * total) {
        if (!prim.has(schema::paths))
            prim.problem(schema::paths, "expected the rows that tss:pathRows counts");
        return paths;
    }
    const double* row = numbers.data();
    for (double count : counts) {
        std::vector<PathRow>& path = paths.emplace_back();
        for (int k = 0; k < count; ++k, row += 8) {
            const Eigen::Quaterniond turn(row[4], row[5], row[6], row[7]);
            if (!(std::abs(turn.norm() - 1) < 1e-3))
                prim.problem(schema::paths,
                             "expected rows of value, translation and a quaternion w, x, y, z of "
                             "length 1, found one of length " +
                                 describe(Value(turn.norm())).substr(7) + " in row " +
                                 std::to_string((row - numbers.data()) / 8));
            if (k > 0 && !(row[0] > path.back().value))
                prim.problem(schema::paths, "expected rising values, found " +
                                                describe(Value(row[0])).substr(7) + " in row " +
                                                std::to_string((row - numbers.data()) / 8));
            path.push_back({row[0], Vec3(row[1], row[2], row[3]), turn.normalized()});
        }
    }
    return paths;
}

void readPath(const PrimReader& prim, const std::vector<std::vector<PathRow>>& paths, std::size_t which,
              Dof& dof) {
    if (which >= paths.size()) {
        prim.problem(schema::dofOrder, "expected a path of tss:paths, found path" + std::to_string(which) +
                                           " of " + std::to_string(paths.size()));
        return;
    }
    dof.path = paths[which];
    dof.lower = dof.path.front().value;
    dof.upper = dof.path.back().value;
    const auto limits = prim.reals(schema::pathLimits, 2 * paths.size());
    if (limits.empty()) return;
    if (limits[2 * which] < dof.lower || limits[2 * which + 1] > dof.upper ||
        limits[2 * which] > limits[2 * which + 1])
        return prim.problem(schema::pathLimits,
                            "expected lower and upper limits within the path's own values");
    dof.lower = limits[2 * which];
    dof.upper = limits[2 * which + 1];
}

void readPlanes(const PrimReader& prim, Joint& joint) {
    const auto numbers = prim.reals(schema::limitPlanes);
    const std::size_t width = joint.dofs.size() + 1;
    if (numbers.size() % width != 0)
        return prim.problem(schema::limitPlanes, "expected rows of " + std::to_string(width) +
                                                     " numbers: a coefficient a DOF and the bound");
    for (std::size_t at = 0; at < numbers.size(); at += width) {
        LimitPlane plane;
        for (std::size_t k = 0; k + 1 < width; ++k) {
            const bool turns = joint.dofs[k].kind == DofKind::Rotation;
            plane.coefficients.push_back(turns ? toDegrees(numbers[at + k]) : numbers[at + k]);
        }
        plane.bound = numbers[at + width - 1];
        joint.planes.push_back(plane);
    }
}

/// One number a DOF, or the fallback for each when the attribute is absent.
std::vector<double> onePerDof(const PrimReader& prim, const Attribute& attribute, std::size_t count,
                              double fallback) {
    auto numbers = prim.reals(attribute, count);
    if (numbers.size() != count) numbers.assign(count, fallback);
    return numbers;
}

std::vector<double> readScales(const PrimReader& prim, const std::vector<std::string>& order) {
    auto scales = onePerDof(prim, schema::dofScale, order.size(), 1);
    for (std::size_t k = 0; k < scales.size(); ++k) {
        const bool slides = order[k].starts_with("trans");
        if (slides ? scales[k] != 0 : scales[k] == 1) continue;
        prim.problem(schema::dofScale, slides ? "expected scales that are not 0"
                                              : "expected a scale of 1 for \"" + order[k] + "\"");
        scales[k] = 1;
    }
    return scales;
}

/// Where no rest is given it is the value nearest to 0 that the limits leave. One that is given is moved to a
/// limit only where it is beyond by the rounding of the file's floats.
double restWithin(const Dof& dof, double rest, bool given) {
    if (!(dof.lower <= dof.upper)) return rest;
    const double within = std::clamp(rest, dof.lower, dof.upper);
    const double rounding = std::ldexp(std::abs(within), -22);
    return !given || std::abs(rest - within) <= rounding ? within : rest;
}

} // namespace

void readDofs(const PrimReader& prim, Joint& joint) {
    const auto order = readOrder(prim);
    const auto scales = readScales(prim, order);
    const bool hasPaths = std::any_of(order.begin(), order.end(),
                                      [](const std::string& token) { return token.starts_with("path"); });
    const auto paths = hasPaths ? readPaths(prim) : std::vector<std::vector<PathRow>>();
    const auto rests = onePerDof(prim, schema::rest, order.size(), 0);
    auto names = prim.texts(schema::dofNames);
    if (prim.has(schema::dofNames) && names.size() != order.size())
        prim.problem(schema::dofNames, "expected " + std::to_string(order.size()) +
                                           " names, one a DOF, found " + std::to_string(names.size()));
    if (names.size() != order.size()) names = order;
    for (std::size_t k = 0; k < order.size(); ++k) {
        Dof dof;
        std::size_t path = 0;
        dofFromToken(order[k], dof, path);
        const DofSlots slots = slotsOf(prim, order[k]);
        if (dof.kind == DofKind::Path)
            readPath(prim, paths, path, dof);
        else
            readLimits(prim, slots, scales[k], dof);
        dof.name = names[k];
        dof.rest = restWithin(dof, dof.kind == DofKind::Rotation ? toRadians(rests[k]) : rests[k],
                              prim.has(schema::rest));
        joint.drives.push_back(readDrive(prim, slots, scales[k], dof));
        if (dof.kind == DofKind::Translation) dof.axis *= scales[k];
        joint.dofs.push_back(std::move(dof));
    }
    readPlanes(prim, joint);
}

} // namespace tss
