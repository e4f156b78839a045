#include "bake/geometry/PartSet.h"
#include "bake/scene/SceneParts.h"

namespace tss {

constinit const Attribute restParts[2][2] = {
    {declared("uniform int[] tss:restTriangles0",
              "where the meshes overlap at rest: parts of the surface of body 0; contact of one of these "
              "with one of body 1 is excepted. A part is a triangle (its index in the mesh, polygons counted "
              "as the triangles they are cut into) and how it is cut"),
     declared("uniform int[] tss:restCuts0",
              "how each part of body 0 is cut: 1 the whole; each further binary digit halves the longest "
              "edge and takes half 0 or 1; where that edge goes from corner a to b, with middle m and c "
              "opposite, their corners are a, m, c and m, b, c, in this order. Of edges ab, bc, ca the first "
              "of equal ones, by (x*x + y*y) + z*z of the difference in double, as rounding tells equal ones "
              "apart; of a leftHanded mesh the second and third corners count as exchanged. Sorted, none in "
              "another; absent: none")},
    {declared("uniform int[] tss:restTriangles1", "the same of body 1"),
     declared("uniform int[] tss:restCuts1", "the same of body 1")}};
constinit const Attribute restDepth =
    declared("uniform double tss:restDepth",
             "tests between spheres of those parts count from this depth on; -1 (absent): there are none");

namespace {

std::vector<SurfacePart> readParts(const PrimReader& prim, const Attribute (&attributes)[2],
                                   const TriangleMesh& mesh) {
    const Attribute &triangles = attributes[0], &cuts = attributes[1];
    const auto whole = prim.indices(triangles), which = prim.indices(cuts);
    if (which.size() != whole.size()) {
        prim.problem(cuts, "expected ", whole.size(), " numbers, one a part of ", triangles.name, ", found ",
                     which.size());
        return {};
    }
    std::vector<SurfacePart> parts;
    PartSet before;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const SurfacePart part{whole[i], which[i]};
        if (part.triangle >= mesh.triangles.size())
            prim.problem(triangles, "expected indices below ", mesh.triangles.size(),
                         ", the number of the body's triangles, found ", part.triangle, " at index ", i);
        else if (part.cuts < 1)
            prim.problem(cuts, "expected 1 or more, found 0 at index ", i);
        else if (i > 0 && !(parts.back() < part))
            prim.problem(triangles, "expected parts in rising order, found none at index ", i);
        else if (before.contains(part))
            prim.problem(cuts, "expected parts of which none is in another, found one at index ", i);
        else {
            parts.push_back(part);
            before.insert(part);
            continue;
        }
        return {};
    }
    return parts;
}

} // namespace

RestRegion readRegion(const SceneReading& reading, const PrimReader& prim, const Pair& pair) {
    const auto mesh = [&](int body) -> const TriangleMesh& { return reading.scene.bodies[body].mesh; };
    RestRegion region;
    region.a = readParts(prim, restParts[0], mesh(pair.bodyA));
    region.b = readParts(prim, restParts[1], mesh(pair.bodyB));
    region.depth = prim.real(restDepth, -1);
    return region;
}

void writeRegion(PrimWriter& prim, const RestRegion& region) {
    for (int body = 0; body < 2; ++body) {
        std::vector<std::uint32_t> whole, which;
        for (const SurfacePart& part : body == 0 ? region.a : region.b) {
            whole.push_back(part.triangle);
            which.push_back(part.cuts);
        }
        for (int k = 0; k < 2; ++k)
            region.empty() ? prim.remove(restParts[body][k])
                           : prim.set(restParts[body][k], k == 0 ? whole : which);
    }
    prim.setUnless(restDepth, region.empty() ? -1 : region.depth, -1.0);
}

} // namespace tss
