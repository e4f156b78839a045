#pragma once
#include "bake/geometry/Solid.h"

#include <optional>

namespace tss::verify {

/// One body of a pair as the verifier takes it, from its mesh alone.
struct VerifiedBody {
    const TriangleMesh& mesh;
    MeshQuery surface;          ///< all triangles, those without area too
    std::optional<Solid> solid; ///< openings filled; nothing for a mesh of segments and points

    /// Throws InputError for a mesh that cannot be used. `mesh` must outlive it.
    explicit VerifiedBody(const TriangleMesh& mesh);
    VerifiedBody(const VerifiedBody&) = delete;
    VerifiedBody& operator=(const VerifiedBody&) = delete;
};

} // namespace tss::verify
