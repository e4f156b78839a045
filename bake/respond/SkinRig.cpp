#include "bake/respond/SkinRig.h"

#include "bake/base/Error.h"
#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/respond/SkinRows.h"
#include "bake/respond/SkinWalk.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tss {
namespace {

constexpr std::uint32_t untouched = 0xffffffff;

void check(const TriangleMesh& skin, std::size_t bodies, const SkinTable& table) {
    const Table& t = table.table;
    if (table.skinVertices.size() != t.a.size() || table.muscleOf.size() != t.b.size() ||
        t.rowOffsets.size() != t.a.size() + 1)
        throw InputError("the table of a skin is incomplete");
    const auto within = [](const std::vector<std::uint32_t>& list, std::size_t count, const char* what) {
        if (std::ranges::any_of(list, [&](std::uint32_t index) { return index >= count; }))
            throw InputError(std::string("the table of a skin names a ") + what + " that it does not have");
    };
    within(table.skinVertices, skin.vertices.size(), "vertex");
    within(table.muscleOf, bodies, "muscle");
    within(t.columns, t.b.size(), "sphere");
}

/// Fills the rig's vertices: those that anything may move, and the ring around them, whose normals turn.
/// Returns for each vertex of the mesh its index among them, or `untouched`.
std::vector<std::uint32_t> addVertices(SkinRig& rig, const SkinAnatomy& anatomy,
                                       const SkinAttachment& attachment,
                                       const std::vector<std::uint32_t>& pushed) {
    const std::size_t count = anatomy.skin.vertices.size();
    std::vector<double> distance(count, infinity);
    lowerDistances(anatomy.graph, pushed, columnReach * anatomy.length, distance);
    for (const auto* lists : {&attachment.frames, &attachment.muscles})
        for (const auto& list : *lists)
            for (std::size_t v = 0; v < list.size(); ++v)
                if (list[v] > 0) distance[v] = 0;
    std::vector<bool> keep(count, false);
    for (std::uint32_t v = 0; v < count; ++v) {
        if (!std::isfinite(distance[v])) continue;
        keep[v] = true;
        for (const SkinGraph::Edge& edge : anatomy.graph.edges[v]) keep[edge.to] = true;
    }
    std::vector<std::uint32_t> indexOf(count, untouched);
    for (const std::uint32_t v : alongCurve(anatomy.skin.vertices)) {
        if (!keep[v] || anatomy.first[v] != v) continue;
        indexOf[v] = static_cast<std::uint32_t>(rig.vertices.size());
        rig.vertices.push_back(v);
        rig.rest.push_back(anatomy.skin.vertices[v]);
        rig.restNormals.push_back(anatomy.inverted ? Vec3(-anatomy.normals[v]) : anatomy.normals[v]);
    }
    for (std::uint32_t v = 0; v < count; ++v) indexOf[v] = indexOf[anatomy.first[v]];
    return indexOf;
}

Move toMove(const Vec3& x) {
    return {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]), 0};
}

Move placeOf(const SkinRig& rig, const Vec3& x) {
    return toMove((x - rig.centre) / rig.size);
}

/// Adds the triangles whose corners are all touched, and the rings of all triangles around touched vertices.
void addTriangles(SkinRig& rig, const TriangleMesh& skin, std::vector<std::uint32_t> indexOf) {
    const auto touched = static_cast<std::uint32_t>(rig.vertices.size());
    std::vector<Tri> at;
    for (const Tri& t : skin.triangles) {
        const auto inside = std::ranges::count_if(t, [&](int v) { return indexOf[v] < touched; });
        if (inside == 0) continue;
        Tri& local = at.emplace_back();
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& index = indexOf[t[k]];
            if (index == untouched) {
                index = touched + static_cast<std::uint32_t>(rig.borderPlaces.size());
                rig.borderPlaces.push_back(placeOf(rig, skin.vertices[t[k]]));
            }
            local[k] = static_cast<int>(index);
        }
        if (inside == 3) rig.triangles.push_back(local);
    }
    std::ranges::stable_sort(rig.triangles, {}, [](const Tri& t) { return t.minCoeff(); });
    rig.across = trianglesAcross(rig.triangles);
    rig.rings = skinRings(at, rig.vertices.size());
    for (const Vec3& x : rig.rest) rig.places.push_back(placeOf(rig, x));
    for (const Vec3& n : rig.restNormals) rig.placeNormals.push_back(toMove(rig.inverted ? Vec3(-n) : n));
}

/// Adds the duplicates of touched vertices along seams.
void addTwins(SkinRig& rig, const SkinAnatomy& anatomy, const std::vector<std::uint32_t>& indexOf) {
    for (std::uint32_t v = 0; v < indexOf.size(); ++v) {
        if (indexOf[v] == untouched || anatomy.first[v] == v) continue;
        rig.vertices.push_back(v);
        rig.twins.push_back(indexOf[v]);
        rig.rest.push_back(anatomy.skin.vertices[v]);
        rig.restNormals.push_back(rig.restNormals[indexOf[v]]);
    }
}

/// Finds which blocks' normals depend on each block.
Lists<std::uint32_t> blocksAround(const SkinRig& rig) {
    std::vector<std::set<std::uint32_t>> around(rig.blocks());
    for (std::uint32_t v = 0; v < rig.vertices.size(); ++v) {
        const auto own = static_cast<std::uint32_t>(v / SkinRig::block);
        around[own].insert(own);
        for (const std::uint32_t place : rig.rings[v / 2])
            if (place / 4 < rig.vertices.size()) around[place / 4 / SkinRig::block].insert(own);
    }
    return Lists<std::uint32_t>(around);
}

Lists<std::uint32_t> nodeBlocks(const SkinFoundation& foundation) {
    std::vector<std::set<std::uint32_t>> blocks(foundation.nodes);
    for (std::size_t v = 0; v < foundation.weights.size(); ++v)
        for (const SkinEntry& entry : foundation.weights[v])
            blocks[entry.index].insert(static_cast<std::uint32_t>(v / SkinRig::block));
    return Lists<std::uint32_t>(blocks);
}

SkinBody bodyOf(const SkinRig& rig, const MuscleDeformer& deformer, int frame, std::span<const int> chain) {
    const Muscle& muscle = deformer.muscle();
    SkinBody body;
    body.count = static_cast<std::uint32_t>(muscle.surface.vertices.size());
    body.triangles = muscle.surface.triangles;
    body.across = trianglesAcross(body.triangles);
    body.nodes = activationNodes(muscle.activationLower, muscle.activationUpper, bodySteps);
    body.restNode = locate(body.nodes, 0).node;
    body.frame = frame;
    body.chain.assign(chain.begin(), chain.end());
    if (!chain.empty()) body.span = std::make_shared<const MuscleSpan>(deformer, rig.size);
    for (const Vec3& x : muscle.surface.vertices) body.rest.push_back(placeOf(rig, x));
    TriangleMesh mesh = muscle.surface;
    for (const double node : body.nodes) {
        mesh.vertices = deformer.vertices(node);
        for (const Vec3& x : mesh.vertices) body.places.push_back(placeOf(rig, x));
        for (const Vec3& n : vertexNormals(mesh)) body.normals.push_back(toMove(n));
    }
    if (!deformer.rigid()) {
        const TriangleMesh& rest = muscle.surface;
        for (const Vec3& o : medialOffsets(rest, ClosestPointQuery(rest), vertexNormals(rest)))
            body.room.push_back(static_cast<float>(o.norm() / rig.size));
    } else {
        body.mesh = std::make_shared<const TriangleMesh>(TriangleMesh{placesOf(body.rest), body.triangles});
        body.locator = std::make_shared<const ClosestPointQuery>(*body.mesh);
    }
    return body;
}

void addBodies(SkinRig& rig, const SkinAnatomy& anatomy, const std::vector<int>& frames) {
    rig.bodies.resize(anatomy.bodies.size());
    parallelFor(rig.bodies.size(), [&](std::size_t m) {
        rig.bodies[m] = bodyOf(rig, *anatomy.bodies[m], frames[m], chainOf(rig.parameters, m));
    });
    for (SkinBody& body : rig.bodies) {
        body.first = static_cast<std::uint32_t>(rig.bodyVertices);
        rig.bodyVertices += body.count;
    }
}

/// Adds what each vertex follows, and which blocks each body and frame moves.
void addShares(SkinRig& rig, const SkinAttachment& attachment) {
    rig.frames = attachment.frames.size();
    rig.frameBlocks.resize(rig.frames);
    for (std::size_t i = 0; i < rig.vertices.size(); ++i) {
        const std::uint32_t v = rig.vertices[i];
        const auto mark = [&](std::vector<std::uint32_t>& blocks) {
            const auto own = static_cast<std::uint32_t>(i / SkinRig::block);
            if (blocks.empty() || blocks.back() != own) blocks.push_back(own);
        };
        for (std::size_t m = 0; m < attachment.muscles.size(); ++m) {
            if (attachment.muscles[m].empty() || !(attachment.muscles[m][v] > 0)) continue;
            const NearestPoint& near = attachment.bindings[m][v];
            const Tri& corners = rig.bodies[m].triangles[near.triangle];
            for (int k = 0; k < 3; ++k)
                if (near.weights[k] > 0)
                    rig.pulls.push_back({rig.bodies[m].first + static_cast<std::uint32_t>(corners[k]),
                                         static_cast<float>(attachment.muscles[m][v] * near.weights[k])});
            mark(rig.bodies[m].blocks);
        }
        for (std::uint32_t f = 0; f < rig.frames; ++f) {
            if (!(attachment.frames[f][v] > 0)) continue;
            rig.frameShares.push_back({f, static_cast<float>(attachment.frames[f][v])});
            mark(rig.frameBlocks[f]);
        }
        rig.pulls.endList();
        rig.frameShares.endList();
    }
}

} // namespace

std::vector<Vec3> placesOf(const std::vector<Move>& vertices) {
    std::vector<Vec3> places;
    for (const Move& x : vertices) places.push_back(x.head<3>().cast<double>());
    return places;
}

Pose SkinRig::local(const Pose& pose) const {
    Pose result = pose;
    result.translation() = (pose * centre - centre) / size;
    return result;
}

std::size_t SkinRig::bytes() const {
    std::size_t sum = foundation.bytes() + rows.size() * sizeof(SkinRow) + clearances.size() * sizeof(Move) +
                      pulls.bytes() + frameShares.bytes() + rings.bytes() + nodeBlocks.bytes() +
                      around.bytes() + vertices.size() * (2 * sizeof(Vec3) + 2 * sizeof(Move)) +
                      2 * triangles.size() * sizeof(Tri);
    for (const SkinBody& body : bodies)
        sum += (body.rest.size() + body.places.size() + body.normals.size()) * sizeof(Move) +
               2 * body.triangles.size() * sizeof(Tri);
    return sum;
}

std::shared_ptr<const SkinRig> makeSkinRig(const TriangleMesh& skin,
                                           const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                                           const SkinTable& table, const SkinParameters& parameters) {
    checkSkin(skin, bodies.size(), parameters);
    check(skin, bodies.size(), table);
    auto result = std::make_shared<SkinRig>();
    SkinRig& rig = *result;
    rig.parameters = parameters;
    const SkinAnatomy anatomy(skin, bodies, parameters);
    rig.size = anatomy.size;
    rig.inverted = anatomy.inverted;
    rig.centre = anatomy.centre;
    double radius = 1e-3 * rig.size;
    for (const Sphere& s : table.table.a) radius = std::max(radius, s.radius);
    rig.radius = static_cast<float>(radius / rig.size);
    const SkinAttachment attachment = attachSkin(anatomy, parameters);
    addBodyRows(rig, anatomy, table);
    std::vector<std::uint32_t> pushed;
    for (const SkinRow& row : rig.rows) pushed.push_back(row.vertex);
    const std::vector<std::uint32_t> indexOf = addVertices(rig, anatomy, attachment, pushed);
    addTriangles(rig, anatomy.skin, indexOf);
    addBodies(rig, anatomy, framesOf(anatomy, parameters));
    addShares(rig, attachment);
    rig.around = blocksAround(rig);
    if (rig.rest.empty()) return result;
    const std::vector<bool> mayBePushed = addRows(rig, indexOf);
    const TriangleMesh local{placesOf(rig.places), rig.triangles};
    std::vector<double> firmness;
    for (const std::uint32_t v : rig.vertices) firmness.push_back(attachment.firmness[v]);
    rig.foundation = skinFoundation(local, skinGraph(local), mayBePushed, firmness, anatomy.length / rig.size,
                                    parameters.stretchCompliance, parameters.bendCompliance);
    rig.nodeBlocks = nodeBlocks(rig.foundation);
    measureRows(rig);
    addTwins(rig, anatomy, indexOf);
    return result;
}

} // namespace tss
