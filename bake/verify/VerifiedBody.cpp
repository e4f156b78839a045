#include "bake/verify/RegionProof.h"

#include "bake/geometry/MeshAudit.h"

namespace tss::verify {

VerifiedBody::VerifiedBody(const TriangleMesh& mesh) : mesh(mesh), surface(mesh) {
    if (auditMesh(mesh).usable()) solid.emplace(cleaned(mesh));
}

} // namespace tss::verify
