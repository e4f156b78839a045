#include "bake/respond/SkinRig.h"

#include "bake/base/Error.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinRigParts.h"
#include "bake/respond/SkinWalk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {
namespace {

using rig::Carried;

constexpr double lookReach = 6;     ///< in thicknesses: how far contacts are looked for
constexpr double foldReach = 3;     ///< in thicknesses: how far another part of the skin is looked for
constexpr double sheetReach = 24;   ///< in thicknesses: how far beyond what is held or hit the sheet moves
constexpr double contactReach = 12; ///< in thicknesses: how far around what may be pushed the sheet gives way
constexpr int dragSteps = 6;        ///< nodes of a drag, without the first
constexpr double rimStiffness = 8;  ///< extra hold at the edge of the touched part, falling off inwards

void checkNumber(double value, const char* what) {
    if (!(value >= 0) || !std::isfinite(value))
        throw InputError(std::string(what) + " of a skin must be finite and at least 0");
}

void check(const TriangleMesh& skin, const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
           const SkinTable& table, const SkinParameters& p) {
    checkNumber(p.stretchCompliance, "the stretch compliance");
    checkNumber(p.bendCompliance, "the bend compliance");
    checkNumber(p.fascia, "the fascia stiffness");
    checkNumber(p.attachment, "the attachment stiffness");
    for (const auto* weights : {&p.tether, &p.attach}) {
        if (!weights->empty() && weights->size() != skin.vertices.size())
            throw InputError("tether and attach of a skin need one value a vertex");
        for (const double w : *weights)
            if (!(w >= 0 && w <= 1)) throw InputError("tether and attach of a skin lie in [0, 1]");
    }
    if (!p.carry.empty() && p.carry.size() != muscles.size())
        throw InputError("carry of a skin needs one value a muscle");
    for (const double w : p.carry)
        if (!(w >= 0 && w <= 1)) throw InputError("carry of a skin lies in [0, 1]");
    for (const BoneSwing& swing : p.swings)
        for (const std::vector<Pose>& station : swing)
            if (station.size() != muscles.size())
                throw InputError("the swings of the bones under a skin need one pose a muscle");
    if (p.iterations < 1) throw InputError("a skin needs at least one iteration");
    const Table& t = table.table;
    if (table.skinVertices.size() != t.a.size() || table.muscleOf.size() != t.b.size() ||
        t.rowOffsets.size() != t.a.size() + 1)
        throw InputError("the table of a skin is incomplete");
    for (const std::uint32_t v : table.skinVertices)
        if (v >= skin.vertices.size())
            throw InputError("the table of a skin names a vertex that it does not have");
    for (const std::uint32_t m : table.muscleOf)
        if (m >= muscles.size()) throw InputError("the table of a skin names a muscle that it does not have");
    for (const std::uint32_t c : t.columns)
        if (c >= t.b.size()) throw InputError("the table of a skin names a sphere that it does not have");
}

double largestRadius(const Table& table) {
    double radius = 0;
    for (const Sphere& s : table.a) radius = std::max(radius, s.radius);
    return radius;
}

/// The touched vertices, their rest places, and how they are held.
struct Touched {
    std::vector<std::uint32_t> indexOf; ///< of a skin vertex in rig.vertices, or past its end
    std::vector<double> distance;       ///< along the sheet from what is held or hit
    double reach = 0;
};

Touched touch(SkinRig& rig, const TriangleMesh& skin, const rig::Rings& rings, const SkinTable& table,
              const std::vector<std::vector<Carried>>& close, double thickness,
              const std::vector<Vec3>& normals) {
    std::vector<std::uint32_t> sources = table.skinVertices;
    for (const auto& list : close)
        for (const Carried& c : list) sources.push_back(c.vertex);
    std::sort(sources.begin(), sources.end());
    sources.erase(std::unique(sources.begin(), sources.end()), sources.end());

    Touched touched;
    touched.reach = rig.parameters.faithful ? 0 : sheetReach * thickness;
    touched.distance = edgeDistances(skin, rings, sources, touched.reach);
    // The ring around them does not move, but its normals turn.
    std::vector<bool> keep(skin.vertices.size(), false);
    for (std::uint32_t v = 0; v < skin.vertices.size(); ++v) {
        if (!std::isfinite(touched.distance[v])) continue;
        keep[v] = true;
        for (const std::uint32_t w : rings.ring[v]) keep[w] = true;
    }
    touched.indexOf.assign(skin.vertices.size(), std::numeric_limits<std::uint32_t>::max());
    for (const std::uint32_t v : rig::alongCurve(skin.vertices)) {
        if (!keep[v]) continue;
        touched.indexOf[v] = static_cast<std::uint32_t>(rig.vertices.size());
        rig.vertices.push_back(v);
        rig.rest.push_back(skin.vertices[v]);
        rig.restNormals.push_back(normals[v]);
    }
    return touched;
}

/// Splits the triangles: those of touched vertices only, and those that bear on a normal.
void addTriangles(SkinRig& rig, const TriangleMesh& skin, const Touched& touched) {
    std::vector<std::uint32_t> borderOf(skin.vertices.size(), std::numeric_limits<std::uint32_t>::max());
    for (const Tri& t : skin.triangles) {
        int inside = 0;
        Tri local;
        for (int k = 0; k < 3; ++k) inside += touched.indexOf[t[k]] < rig.vertices.size();
        if (inside == 0) continue;
        for (int k = 0; k < 3; ++k) {
            std::uint32_t index = touched.indexOf[t[k]];
            if (index >= rig.vertices.size()) {
                std::uint32_t& border = borderOf[t[k]];
                if (border >= rig.border.size()) {
                    border = static_cast<std::uint32_t>(rig.border.size());
                    rig.border.push_back(skin.vertices[t[k]]);
                }
                index = static_cast<std::uint32_t>(rig.vertices.size()) + border;
            }
            local[k] = static_cast<int>(index);
        }
        if (inside == 3) rig.triangles.push_back(local);
        rig.normalTriangles.push_back(local);
    }
    const auto byFirstVertex = [](const Tri& a, const Tri& b) { return a.minCoeff() < b.minCoeff(); };
    std::stable_sort(rig.triangles.begin(), rig.triangles.end(), byFirstVertex);
    std::stable_sort(rig.normalTriangles.begin(), rig.normalTriangles.end(), byFirstVertex);
}

/// Mass of a vertex from its area, 1 on average, so that the sheet behaves alike on meshes of uneven density.
std::vector<double> areaMasses(const SkinRig& rig) {
    std::vector<double> areas(rig.vertices.size(), 0);
    for (const Tri& t : rig.triangles) {
        const double area = (rig.rest[t[1]] - rig.rest[t[0]]).cross(rig.rest[t[2]] - rig.rest[t[0]]).norm();
        for (int k = 0; k < 3; ++k) areas[t[k]] += area;
    }
    double mean = 0;
    for (const double a : areas) mean += a / static_cast<double>(areas.size());
    for (double& a : areas) a = mean > 0 ? std::clamp(a / mean, 0.1, 10.0) : 1;
    return areas;
}

/// Stiffness of what holds a vertex to its rest place, beside the 1 that holds every one.
double tetherOf(const SkinParameters& p, std::uint32_t vertex) {
    const double tether = p.tether.empty() ? 0 : p.tether[vertex];
    return p.attachment * tether / (1.001 - tether);
}

void addHolds(SkinRig& rig, const Touched& touched, const std::vector<std::vector<Carried>>& close) {
    const SkinParameters& p = rig.parameters;
    const std::vector<double> areas = areaMasses(rig);
    std::vector<double> carried(rig.vertices.size(), 0);
    for (const auto& list : close)
        for (const Carried& c : list) carried[touched.indexOf[c.vertex]] += c.pull;
    for (std::size_t i = 0; i < rig.vertices.size(); ++i) {
        const std::uint32_t v = rig.vertices[i];
        const double out = touched.reach > 0 ? std::min(1.0, touched.distance[v] / touched.reach) : 0;
        const double kept = 1 + rimStiffness * out * out + tetherOf(p, v);
        // Carried by the muscles for a share of the way: as if by springs so much stiffer than the first.
        const double held = areas[i] * (kept + carried[i] / (1 - carried[i]));
        rig.sheet.inverseMass.push_back(std::isfinite(touched.distance[v]) ? static_cast<float>(1 / held)
                                                                           : 0);
    }
    for (std::size_t m = 0; m < close.size(); ++m)
        for (const Carried& c : close[m]) {
            const std::uint32_t i = touched.indexOf[c.vertex];
            const double stiffness = areas[i] * c.pull / (1 - carried[i]);
            rig.muscles[m].carried.push_back({i, static_cast<float>(stiffness) * rig.sheet.inverseMass[i]});
        }
}

/// Returns where each sphere of the table is among its own muscle's.
std::vector<std::uint32_t> addTracks(SkinRig& rig,
                                     const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
                                     const SkinTable& table, const std::vector<std::vector<Carried>>& close) {
    std::vector<std::vector<Sphere>> spheres(muscles.size());
    std::vector<std::uint32_t> own(table.table.b.size());
    for (std::size_t b = 0; b < table.table.b.size(); ++b) {
        auto& list = spheres[table.muscleOf[b]];
        own[b] = static_cast<std::uint32_t>(list.size());
        list.push_back(table.table.b[b]);
    }
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        const MuscleDeformer& deformer = *muscles[m];
        SkinMuscle& muscle = rig.muscles[m];
        const std::vector<double> nodes =
            activationNodes(deformer.muscle().activationLower, deformer.muscle().activationUpper);
        std::vector<MusclePoint> points;
        for (const Sphere& s : spheres[m]) {
            points.push_back(deformer.bind(s.centre));
            muscle.radii.push_back(s.radius);
        }
        muscle.spheres = makeTrack(deformer, points, nodes);
        muscle.surface = makeTrack(deformer, deformer.surfacePoints(), nodes);
        points.clear();
        for (const Carried& c : close[m]) points.push_back(c.point);
        muscle.skin = makeTrack(deformer, points, nodes);
        muscle.rest = deformer.muscle().surface.vertices;
        muscle.triangles = deformer.muscle().surface.triangles;
    }
    return own;
}

/// Splits each row of the table by the muscles that it meets.
void addRows(SkinRig& rig, const SkinTable& table, const Touched& touched,
             const std::vector<std::uint32_t>& own) {
    const Table& t = table.table;
    for (std::size_t i = 0; i < t.a.size(); ++i)
        for (std::uint32_t m = 0; m < rig.muscles.size(); ++m) {
            SkinRow row;
            row.vertex = touched.indexOf[table.skinVertices[i]];
            row.muscle = m;
            row.radius = t.a[i].radius;
            row.first = static_cast<std::uint32_t>(rig.tests.size());
            for (std::uint32_t k = t.rowOffsets[i]; k < t.rowOffsets[i + 1]; ++k)
                if (table.muscleOf[t.columns[k]] == m)
                    rig.tests.push_back({own[t.columns[k]], t.restGaps.empty() ? 0 : t.restGaps[k]});
            row.last = static_cast<std::uint32_t>(rig.tests.size());
            if (row.last > row.first) rig.rows.push_back(row);
        }
}

/// What each row and poke keeps: its own distance at rest where that is less than the thickness. Found by the
/// look-up of the run time, or the skin would never come back to rest (METHOD 6.2).
void addOffsets(SkinRig& rig) {
    SkinScene scene;
    const std::vector<double> none(rig.muscles.size(), 0.0);
    placeMuscles(rig, none, std::vector<Pose>(rig.muscles.size(), Pose::Identity()), scene);
    for (std::size_t i = 0; i < rig.rows.size(); ++i) {
        const double radius = rig.rows[i].radius;
        const SkinContact c = rowContact(rig, scene, i);
        rig.rowOffsets.push_back(c.found() ? std::min(c.distance, radius) : radius);
    }
    for (std::size_t i = 0; i < rig.pokes.size(); ++i) {
        const SkinContact c = pokeContact(rig, scene, i);
        rig.pokeOffsets.push_back(c.found() ? std::min(c.distance, rig.pokes[i].radius)
                                            : rig.pokes[i].radius);
    }
    for (std::size_t i = 0; i < rig.folds.size(); ++i) {
        const SkinContact c = foldContact(rig, scene, i);
        rig.foldOffsets.push_back(c.found() ? std::min(c.distance, 0.0) : 0);
    }
}

void addDrags(SkinRig& rig, const TriangleMesh& skin, const rig::Rings& rings,
              const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles, double reach) {
    for (std::size_t m = 0; m < rig.muscles.size(); ++m) {
        SkinMuscle& muscle = rig.muscles[m];
        const Muscle& source = muscles[m]->muscle();
        muscle.drag.nodes = activationNodes(source.activationLower, source.activationUpper, dragSteps);
        std::vector<std::uint32_t> carried;
        for (const SkinCarry& c : muscle.carried) carried.push_back(c.vertex);
        rig::addDrag(rig, rig::patchAround(rig, skin, rings, carried, reach), muscle);
    }
}

void addContactPatch(SkinRig& rig, const TriangleMesh& skin, const rig::Rings& rings, double reach) {
    std::vector<std::uint32_t> vertices;
    for (const SkinRow& row : rig.rows) vertices.push_back(row.vertex);
    for (const SkinMuscle& muscle : rig.muscles)
        for (const SkinCarry& c : muscle.carried) vertices.push_back(c.vertex);
    for (const int t : rig.pokeTriangles)
        if (t >= 0)
            for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<std::uint32_t>(rig.triangles[t][k]));
    for (const SkinFold& fold : rig.folds) {
        vertices.push_back(fold.vertex);
        for (std::uint32_t k = fold.first; k < fold.last; ++k)
            for (const int corner : rig.triangles[rig.foldTriangles[k]])
                vertices.push_back(static_cast<std::uint32_t>(corner));
    }
    rig.contactPatch = rig::patchAround(rig, skin, rings, vertices, reach);
    // The walk of a poke may end a little outside: there, and beyond, nothing moves.
    rig.contactIndex.assign(rig.rest.size(), SkinRig::outside);
    for (std::uint32_t i = 0; i < rig.contactPatch.vertices.size(); ++i)
        rig.contactIndex[rig.contactPatch.vertices[i]] = i;
}

} // namespace

std::vector<Vec3> skinNormals(const TriangleMesh& skin) {
    std::vector<Vec3> normals(skin.vertices.size(), Vec3::Zero());
    for (const Tri& t : skin.triangles) {
        const Vec3& a = skin.vertices[t[0]];
        const Vec3 n = (skin.vertices[t[1]] - a).cross(skin.vertices[t[2]] - a);
        for (int k = 0; k < 3; ++k) normals[t[k]] += n;
    }
    for (Vec3& n : normals) n.normalize();
    return normals;
}

SkinMoves skinMoves(const TriangleMesh& skin,
                    const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
                    const SkinParameters& parameters, double thickness) {
    SkinMoves moves;
    moves.stray.assign(muscles.size(), std::vector<double>(skin.vertices.size(), 0));
    moves.shares = moves.stray;
    const auto carried =
        rig::carriedSkin(skin, skinNormals(skin), rig::rings(skin), muscles, parameters, thickness);
    std::vector<double> total(skin.vertices.size(), 0);
    for (const auto& list : carried)
        for (const Carried& c : list) total[c.vertex] += c.pull;
    for (std::size_t m = 0; m < muscles.size(); ++m)
        for (const Carried& c : carried[m]) {
            moves.shares[m][c.vertex] = c.pull / (1 + (1 - total[c.vertex]) * tetherOf(parameters, c.vertex));
            for (std::size_t other = 0; other < muscles.size(); ++other)
                if (other != m) moves.stray[other][c.vertex] += c.pull * c.contracted;
        }
    return moves;
}

std::shared_ptr<const SkinRig> makeSkinRig(const TriangleMesh& skin,
                                           const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
                                           const SkinTable& table, const SkinParameters& parameters) {
    check(skin, muscles, table, parameters);
    auto result = std::make_shared<SkinRig>();
    SkinRig& rig = *result;
    rig.parameters = parameters;
    rig.size = skin.vertices.empty() ? 0 : bounds(skin).diagonal().norm();
    rig.travel = table.travel;
    rig.muscles.resize(muscles.size());
    const double thickness = largestRadius(table.table);
    const double reach = lookReach * thickness;

    const rig::Rings rings = rig::rings(skin);
    const std::vector<Vec3> normals = skinNormals(skin);
    std::vector<std::vector<Carried>> close(muscles.size());
    if (!parameters.faithful) close = rig::carriedSkin(skin, normals, rings, muscles, parameters, thickness);

    const Touched touched = touch(rig, skin, rings, table, close, thickness, normals);
    addTriangles(rig, skin, touched);
    addHolds(rig, touched, close);
    const std::vector<std::uint32_t> own = addTracks(rig, muscles, table, close);
    addRows(rig, table, touched, own);
    if (!parameters.faithful) {
        rig::addSheet(rig, rings, touched.indexOf);
        rig.across = trianglesAcross(rig.triangles);
        rig.weave = makeWeave(rig.rest, rig.triangles, rig.sheet.inverseMass);
        addDrags(rig, skin, rings, muscles, touched.reach);
        for (std::uint32_t m = 0; m < muscles.size(); ++m) {
            rig::addRowTriangles(rig, m, reach);
            rig::addPokes(rig, m, thickness, reach);
        }
        if (parameters.selfContact) rig::addFolds(rig, thickness, foldReach * thickness);
    }
    if (!parameters.faithful) addOffsets(rig);
    addContactPatch(rig, skin, rings, contactReach * thickness);
    return result;
}

} // namespace tss
