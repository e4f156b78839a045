#pragma once
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// Middle of the left eyeball and the way it looks; its radius.
inline const Vec3 eyeCentre{58, 24.5, 19};
inline const Vec3 gaze = Vec3(0.74, 0.62, 0.16).normalized();
constexpr double eyeRadius = 10.2;

/// The outside of the head with the mouth closed: muzzle, lips with a mouth line, eyelids around open eyes,
/// brow, cheeks, upright ears, and the neck far enough back to be cut. The skull's frame; it lies outside
/// skull, mandible and frontalis().
Field headSkin();

/// z where the lips meet, for x from the corner of the mouth to the nose's foot.
double mouthHeight(double x);

/// The same with the mouth cut through from lip to lip, so that it can open.
Field headSkinMouthCut();

/// The stiff shell in the left ear above its root, wholly inside the skin.
Field earCartilage();

/// The nose pad with its nostrils: a body of its own, let into the muzzle's tip.
Field nosePad();

} // namespace doghead
