#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"
#include "examples/doghead/implicit/Field.h"

namespace doghead {

using tss::TriangleMesh;

/// How finely the dog is meshed.
struct Detail {
    double cell = 0.8;       ///< of the first raw mesh, mm: gaps narrower than this may close
    double deviation = 0.17; ///< mm, see RemeshOptions
};

// Meshes of the parts, in the skull's frame with the mouth closed; millimetres rounded to micrometres, so
// that files stay short. Closed and outward oriented but for the skin.
TriangleMesh skullMesh(const Detail& detail = {});
TriangleMesh mandibleMesh(const Detail& detail = {});
TriangleMesh frontalisMesh(const Detail& detail = {});
TriangleMesh nosePadMesh(const Detail& detail = {});
TriangleMesh eyesMesh();   ///< both eyeballs
TriangleMesh irisesMesh(); ///< both, let into the eyeballs

/// The skin of the left half of the head, over the middle line by a few millimetres; open at the neck and
/// along the cut, finer over the forehead.
TriangleMesh leftSkinMesh(const Detail& detail = {1.2, 0.25});

/// The same with the mouth cut through, finer about it.
TriangleMesh leftSkinMouthCutMesh(const Detail& detail = {1, 0.25});

/// The skin of the whole head; open at the neck.
TriangleMesh skinMesh(const Detail& detail);
TriangleMesh skinMouthCutMesh(const Detail& detail);               ///< with the mouth cut through
TriangleMesh earCartilageMesh(const Detail& detail = {0.7, 0.25}); ///< the left one
/// A muscle under the skin, and the like.
TriangleMesh bodyMesh(const Field& field, const Detail& detail = {0.7, 0.2});

/// The left ear laid back: about the left-right axis through its root; 0 upright, positive back. Its upper
/// limit lies beyond the contact with the skull on purpose.
tss::Motion earMotion();

/// The jaw: yaw about Z, then open about Y (T = Rz(yaw) Ry(open)), both through the origin. open 0 is the
/// mouth closed, + opens; it rests ajar. The limits lie beyond the contact of the teeth on purpose.
tss::Motion jawMotion();

} // namespace doghead
