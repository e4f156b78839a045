#pragma once
#include "examples/doghead/implicit/Field.h"

#include <string>
#include <vector>

namespace doghead {

/// Room left around the jaw's condyles in their sockets, mm.
constexpr double socketClearance = 0.9;

/// The condyle of the left jaw joint: a roller on the hinge axis (the Y axis) and its neck ends.
constexpr double condyleRadius = 3.8, condyleInner = 30.5, condyleOuter = 40.5;

/// The brain case and the forehead without crests and arches: what the muscles of the brow lie on.
Field cranium();

/// The skull without the mandible, with its upper teeth, one closed surface; about 174 mm long. Origin midway
/// between the jaw joints, +X nose, +Y left, +Z up, millimetres.
Field skull();

/// The mandible with its lower teeth, one closed surface, in the skull's frame with the mouth closed (the
/// teeth just free of each other). It hinges about the Y axis.
Field mandible();

/// The twenty teeth of the upper jaw (3 incisors, canine, 4 premolars of which the last is the carnassial, 2
/// molars a side), in the skull's frame: origin midway between the jaw joints, +X nose, +Y left, +Z up,
/// millimetres.
Field upperTeeth();

/// The twenty-two teeth of the lower jaw (3 incisors, canine, 4 premolars, 3 molars a side, the first the
/// carnassial), in the same frame with the mouth closed: the lower row stands inside the upper one, the lower
/// canine before the upper canine.
Field lowerTeeth();

/// Middle of the left eyeball and the way it looks; its radius.
inline const Vec3 eyeCentre{58, 24.5, 19};
inline const Vec3 gaze = Vec3(0.74, 0.62, 0.16).normalized();
constexpr double eyeRadius = 10.2;

/// The outside of the head with the mouth closed: muzzle, lips with a mouth line, eyelids around open eyes,
/// brow, cheeks, upright ears, and the neck far enough back to be cut. The skull's frame; it lies outside
/// skull, mandible and frontalis().
Field headSkin();

/// The same with the mouth cut through from lip to lip, so that it can open.
Field headSkinMouthCut();

/// The room of that mouth behind its lips, whose lining is no skin.
Field behindLips();

/// The stiff shell in the left ear above its root, wholly inside the skin.
Field earCartilage();

/// The nose pad with its nostrils: a body of its own, let into the muzzle's tip.
Field nosePad();

/// The frontalis: a sheet over the forehead, from the crest of the skull forward to the brows, in the skull's
/// frame.
Field frontalis();

/// Its fibre line in the middle plane, from the origin on the crest to the insertion at the brow.
std::vector<Vec3> frontalisFibre();

/// A muscle of the face as a strap under the skin.
struct Strap {
    std::string name;
    std::vector<Vec3> fibre; ///< from origin to insertion
    Field field;
    double contraction = 0.2; ///< greatest shortening, of the chord
};

/// The muscles of the left side that move lips, eyelids and cheek: zygomaticus, levator nasolabialis,
/// orbicularis oris, retractor anguli oculi, masseter and temporalis. Each lies wholly under the skin,
/// closely.
std::vector<Strap> faceStraps();

/// The strap of the other side.
Strap mirroredStrap(const Strap& strap);

} // namespace doghead
