#include "tests/adversary/scenes/FileDamage.h"

#include "tests/adversary/scenes/BakedFile.h"

#include <algorithm>

namespace adversary {

namespace {

/// False where it does not apply.
using Change = std::function<bool(BakedFile&)>;

struct DamageKind {
    std::string name;
    bool hashed;
    Change change;
};

std::vector<DamageKind> sphereKinds() {
    return {
        {"radii of A cut by a tenth", false, [](BakedFile& f) { return scaleRadii(f, 0, 0.9); }},
        {"radii of B cut by a tenth", false, [](BakedFile& f) { return scaleRadii(f, 1, 0.9); }},
        {"radii of both cut by a thousandth", false,
         [](BakedFile& f) { return scaleRadii(f, 0, 0.999) && scaleRadii(f, 1, 0.999); }},
        {"radii cut and counted as all there are", false,
         [](BakedFile& f) { return scaleRadii(f, 0, 0.9) && scaleRadii(f, 1, 0.9) && countsAsStored(f); }},
        {"a radius of A halved", false, [](BakedFile& f) { return growRadius(f, 0, 0, 0.5); }},
        {"a radius of B all but gone", false, [](BakedFile& f) { return growRadius(f, 1, 0, 1e-6); }},
        {"a radius of A grown by the tolerance", false,
         [](BakedFile& f) { return growRadius(f, 0, f.length); }},
        {"a radius of B grown much", false, [](BakedFile& f) { return growRadius(f, 1, 8 * f.length); }},
        {"all radii grown by a tenth", false,
         [](BakedFile& f) { return scaleRadii(f, 0, 1.1) && scaleRadii(f, 1, 1.1); }},
        {"a centre of A moved", false, [](BakedFile& f) { return moveCentres(f, 0, f.length, false); }},
        {"a centre of B moved a little", false,
         [](BakedFile& f) { return moveCentres(f, 1, 0.01 * f.length, false); }},
        {"all centres of A moved", false, [](BakedFile& f) { return moveCentres(f, 0, f.length, true); }},
        {"all centres of B moved far", false,
         [](BakedFile& f) { return moveCentres(f, 1, 20 * f.length, true); }},
        {"the centres of A in another order", false,
         [](BakedFile& f) {
             Json& points = *f.values(f.spheres.at(0), "points");
             std::rotate(points.begin(), points.begin() + 1, points.end());
             return points.size() > 1;
         }},
        {"the radii of B in another order", false,
         [](BakedFile& f) {
             Json& widths = *f.values(f.spheres.at(1), "widths");
             std::rotate(widths.begin(), widths.begin() + 1, widths.end());
             return widths.size() > 1;
         }},
    };
}

std::vector<DamageKind> testKinds() {
    return {
        {"a test left out", false,
         [](BakedFile& f) {
             const std::size_t out = f.tests() ? f.any(f.tests()) : 0;
             return keepTests(f, [out](std::size_t k) { return k != out; });
         }},
        {"the first test left out", false,
         [](BakedFile& f) { return keepTests(f, [](std::size_t k) { return k != 0; }); }},
        {"every other test left out", false,
         [](BakedFile& f) { return keepTests(f, [](std::size_t k) { return k % 2 == 0; }); }},
        {"one test left", false,
         [](BakedFile& f) { return keepTests(f, [](std::size_t k) { return k == 0; }); }},
        {"no test left", false, [](BakedFile& f) { return keepTests(f, [](std::size_t) { return false; }); }},
        {"columns one further", false,
         [](BakedFile& f) { return changeColumns(f, [](int c, int n) { return (c + 1) % n; }); }},
        {"columns all the first", false,
         [](BakedFile& f) { return changeColumns(f, [](int, int) { return 0; }); }},
        {"columns reversed", false,
         [](BakedFile& f) { return changeColumns(f, [](int c, int n) { return n - 1 - c; }); }},
        {"thresholds lower by the tolerance", false,
         [](BakedFile& f) { return changeGaps(f, [&](double g) { return g - f.length; }); }},
        {"a threshold lower by far", false,
         [](BakedFile& f) {
             return changeGaps(
                 f, [&](double g) { return g - 20 * f.length; }, false);
         }},
        {"a threshold lower by a thousandth", false,
         [](BakedFile& f) {
             return changeGaps(
                 f, [&](double g) { return g - 1e-3 * f.length; }, false);
         }},
        {"thresholds higher by the tolerance", false,
         [](BakedFile& f) { return changeGaps(f, [&](double g) { return g + f.length; }); }},
        {"thresholds doubled", false,
         [](BakedFile& f) {
             return f.tableValues("tss:restGaps") && changeGaps(f, [](double g) { return 2 * g; });
         }},
        {"thresholds gone", false,
         [](BakedFile& f) { return (*f.table)["properties"].erase("tss:restGaps") > 0; }},
    };
}

std::vector<DamageKind> claimKinds() {
    const auto claims = [](const char* name, double value) {
        return [=](BakedFile& f) {
            if (f.claimed(name, 0) == value) return false;
            f.claim(name, value);
            return true;
        };
    };
    const auto factor = [](const char* name, double by) {
        return [=](BakedFile& f) { return factorClaim(f, name, by); };
    };
    return {
        {"no misses claimed", false, claims("tss:boundMiss", 0)},
        {"no misses claimed and coverage said to be whole", false,
         [](BakedFile& f) {
             if (!(f.claimed("tss:boundMiss", -1) != 0)) return false;
             f.claim("tss:boundMiss", 0);
             return perBody(f, "tss:coverage", "double[]", 0);
         }},
        {"half as late claimed", false, factor("tss:boundMiss", 0.5)},
        {"nothing claimed of misses", false, claims("tss:boundMiss", -1)},
        {"nothing early claimed", false, claims("tss:boundEarly", 0)},
        {"half as early claimed", false, factor("tss:boundEarly", 0.5)},
        {"half as early claimed, spheres said to stick out less", false,
         [](BakedFile& f) {
             return factorClaim(f, "tss:boundEarly", 0.5) && perBody(f, "tss:protrusion", "double[]", 1e-9);
         }},
        {"early by far claimed", false, factor("tss:boundEarly", 100)},
        {"a smaller epsilon claimed", false, factor("tss:epsilon", 0.01)},
        {"a larger epsilon claimed", false, claims("tss:epsilon", 1)},
        {"a larger depth claimed", false,
         [](BakedFile& f) {
             f.claim("tss:gapDepth", 40 * f.length);
             return true;
         }},
        {"a margin claimed", false,
         [](BakedFile& f) {
             f.claim("tss:gapMargin", 10 * f.length);
             return true;
         }},
        {"no depth claimed", false,
         [](BakedFile& f) { return (*f.table)["properties"].erase("tss:gapDepth") > 0; }},
        {"made from other numbers of spheres", false,
         [](BakedFile& f) { return perBody(f, "tss:generatedSpheres", "uint64[]", 3); }},
        {"a proof in the table's place", false, [](BakedFile& f) { return becomeProof(f, 1e-6); }},
        {"a proof with a clearance in the table's place", false,
         [](BakedFile& f) { return becomeProof(f, f.length); }},
    };
}

std::vector<DamageKind> sourceKinds() {
    return {
        {"a limit wider by a tenth", true, [](BakedFile& f) { return widen(f, 0.1); }},
        {"a limit twice as wide", true, [](BakedFile& f) { return widen(f, 1); }},
        {"a joint moved", true, [](BakedFile& f) { return moveJoint(f, 4 * f.length); }},
        {"the moving mesh moved", true, [](BakedFile& f) { return moveMesh(f, 1, 1, 4 * f.length); }},
        {"the still mesh moved a little", true,
         [](BakedFile& f) { return moveMesh(f, 0, 1, 0.1 * f.length); }},
        {"the still mesh larger", true, [](BakedFile& f) { return moveMesh(f, 0, 1.1, 0); }},
        {"the moving mesh smaller", true, [](BakedFile& f) { return moveMesh(f, 1, 0.9, 0); }},
        {"a vertex pulled out", true,
         [](BakedFile& f) {
             Json& points = *f.values(f.meshes.at(1), "points");
             Json& point = points[f.any(points.size())];
             point[f.any(3)] = point[0].get<double>() + 10 * f.length;
             return true;
         }},
        {"overlap at rest said to be ignored", true,
         [](BakedFile& f) { return setting(f, "at_rest", "ignore"); }},
        {"a coarser tolerance said", true,
         [](BakedFile& f) { return setting(f, "tolerance", std::to_string(4 * f.length)); }},
        {"inscribed spheres said", true, [](BakedFile& f) { return setting(f, "conservative", "false"); }},
        {"a planar limit gone, or put", true,
         [](BakedFile& f) { return (*f.joints.at(0))["properties"].erase("tss:limitPlanes") > 0; }},
        {"another rest", true,
         [](BakedFile& f) {
             f.set(f.joints.at(0), "tss:rest", "double[]", Json::array({0.01}));
             return f.joints.size() == 1 && f.values(f.joints[0], "physics:lowerLimit");
         }},
        {"all of both surfaces exempt", false,
         [](BakedFile& f) { return exempt(f, 0, 1u << 30) && exempt(f, 1, 1u << 30); }},
        {"all of A exempt from some of B", false,
         [](BakedFile& f) { return exempt(f, 0, 1u << 30) && exempt(f, 1, 4); }},
        {"a triangle of each exempt", false,
         [](BakedFile& f) { return !hasRegion(f) && exempt(f, 0, 1) && exempt(f, 1, 1); }},
        {"nothing exempt", false,
         [](BakedFile& f) {
             const bool had = hasRegion(f);
             withoutRegion(f);
             return had;
         }},
        {"the exempt parts half as deep", false,
         [](BakedFile& f) { return factorClaim(f, "tss:restDepth", 0.5); }},
        {"the exempt parts deeper", false, [](BakedFile& f) { return factorClaim(f, "tss:restDepth", 3); }},
        {"damaged radii in a file that says it is fresh", true,
         [](BakedFile& f) { return scaleRadii(f, 0, 0.95) && countsAsStored(f); }},
    };
}

const std::vector<DamageKind>& kindsOfDamage() {
    static const std::vector<DamageKind> all = [] {
        std::vector<DamageKind> list;
        for (const auto make : {sphereKinds, testKinds, claimKinds, sourceKinds})
            for (DamageKind& kind : make()) list.push_back(std::move(kind));
        return list;
    }();
    return all;
}

} // namespace

const std::vector<Damage>& damages() {
    static const std::vector<Damage> all = [] {
        std::vector<Damage> list;
        for (const DamageKind& kind : kindsOfDamage()) list.push_back({kind.name, kind.hashed});
        return list;
    }();
    return all;
}

std::string damaged(const std::string& text, std::size_t damage, double length, std::uint64_t seed) {
    BakedFile file(text, length, seed);
    if (!file.table || file.spheres.size() < 2 || file.meshes.size() < 2 || !file.pair) return {};
    return kindsOfDamage().at(damage).change(file) ? file.doc.dump() : std::string();
}

} // namespace adversary
