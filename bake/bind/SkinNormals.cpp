#include "bake/bind/SkinNormals.h"

#include <algorithm>
#include <utility>

namespace tss {
namespace {

/// The two other corners of a triangle at a vertex, in the triangle's order.
using Side = std::pair<std::uint32_t, std::uint32_t>;

using Ring = std::vector<std::uint32_t>;

/// Takes triangles that follow one another around a vertex, from a rim of the mesh where there is one: their
/// corners, the first again at the end where they go all around.
Ring takeChain(std::vector<Side>& sides) {
    const auto isFirst = [&](const Side& side) {
        return std::ranges::find(sides, side.first, &Side::second) == sides.end();
    };
    auto next = std::ranges::find_if(sides, isFirst);
    if (next == sides.end()) next = sides.begin();
    Ring chain{next->first};
    while (next != sides.end()) {
        chain.push_back(next->second);
        sides.erase(next);
        next = std::ranges::find(sides, chain.back(), &Side::first);
    }
    return chain;
}

/// The ring of a vertex from its sides; begins with the second corner of the first chain.
Ring ringOf(std::vector<Side> sides, std::uint32_t vertex) {
    Ring ring;
    while (!sides.empty()) {
        Ring chain = takeChain(sides);
        if (chain.size() % 2 == 0) chain.push_back(chain.back());
        const bool closes = ring.empty() && sides.empty() && chain.front() == chain.back();
        ring.insert(ring.end(), chain.begin(), chain.end() - (closes ? 1 : 0));
        if (!closes) ring.push_back(vertex); // no area from one chain to the next
    }
    if (!ring.empty()) std::ranges::rotate(ring, ring.begin() + 1);
    return ring;
}

} // namespace

std::vector<Vec3> skinNormals(const TriangleMesh& skin) {
    std::vector<Vec3> normals(skin.vertices.size(), Vec3::Zero());
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
        const Tri& t = skin.triangles[i];
        const Vec3 n = skin.areaNormal(i);
        for (int k = 0; k < 3; ++k) normals[t[k]] += n;
    }
    for (Vec3& n : normals)
        if (n.squaredNorm() > 0) n.normalize();
    return normals;
}

Lists<std::uint32_t> skinRings(const std::vector<Tri>& triangles, std::size_t count) {
    std::vector<std::vector<Side>> sides(count);
    for (const Tri& t : triangles)
        for (int k = 0; k < 3; ++k)
            if (static_cast<std::size_t>(t[k]) < count)
                sides[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    Lists<std::uint32_t> rings;
    for (std::uint32_t v = 0; v < count; v += 2) {
        Ring pair[2] = {ringOf(sides[v], v), v + 1 < count ? ringOf(sides[v + 1], v + 1) : Ring{}};
        const std::size_t longest = std::max({pair[0].size(), pair[1].size(), std::size_t(2)});
        for (Ring& ring : pair) ring.resize(longest, ring.empty() ? v : ring.back());
        for (std::size_t k = 0; k < longest; ++k)
            for (const Ring& ring : pair) rings.push_back(4 * ring[k]);
        rings.endList();
    }
    return rings;
}

} // namespace tss
