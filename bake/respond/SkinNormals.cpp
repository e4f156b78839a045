#include "bake/respond/SkinNormals.h"

#include <utility>

namespace tss {
namespace {

/// The two other corners of a triangle at a vertex, in its turn.
using Side = std::pair<std::uint32_t, std::uint32_t>;

/// Takes one triangle after the other, each time with the next one around where there is one.
void pairUp(std::vector<Side>& sides, std::uint32_t vertex, Lists<SkinFan>& fans) {
    const auto follower = [&](std::uint32_t corner) {
        std::size_t k = 0;
        while (k < sides.size() && sides[k].first != corner) ++k;
        return k;
    };
    const auto isLed = [&](std::size_t at) {
        for (const Side& side : sides)
            if (side.second == sides[at].first) return true;
        return false;
    };
    while (!sides.empty()) {
        std::size_t at = 0; // at a rim from where nothing comes before, so that few are left alone
        while (at + 1 < sides.size() && isLed(at)) ++at;
        if (isLed(at)) at = 0;
        const Side side = sides[at];
        sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(at));
        const std::size_t next = follower(side.second);
        if (next == sides.size()) {
            fans.push_back({side.first, side.second, vertex});
            continue;
        }
        fans.push_back({side.second, sides[next].second, side.first});
        sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(next));
    }
    fans.endList();
}

} // namespace

std::vector<Vec3> skinNormals(const TriangleMesh& skin) {
    std::vector<Vec3> normals(skin.vertices.size(), Vec3::Zero());
    for (const Tri& t : skin.triangles) {
        const Vec3& a = skin.vertices[t[0]];
        const Vec3 n = (skin.vertices[t[1]] - a).cross(skin.vertices[t[2]] - a);
        for (int k = 0; k < 3; ++k) normals[t[k]] += n;
    }
    for (Vec3& n : normals)
        if (n.squaredNorm() > 0) n.normalize();
    return normals;
}

Lists<SkinFan> skinFans(const std::vector<Tri>& triangles, std::size_t count) {
    std::vector<std::vector<Side>> sides(count);
    for (const Tri& t : triangles)
        for (int k = 0; k < 3; ++k)
            if (static_cast<std::size_t>(t[k]) < count)
                sides[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    Lists<SkinFan> fans;
    for (std::uint32_t v = 0; v < count; ++v) pairUp(sides[v], v, fans);
    return fans;
}

} // namespace tss
