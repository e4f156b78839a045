#pragma once
#include "bake/model/SceneModel.h"
#include "examples/doghead/DogMeshes.h"

namespace doghead {

/// A skull and a mandible that chews for four seconds: it opens wide, then is asked to close and to grind
/// sideways through the point where the teeth meet.
tss::SceneModel jawScene();

/// The frontalis on its skull, tightening and letting go in three seconds, under the skin of the left half of
/// the head; the right half lies open. The mandible, the nose and the eyes are there to be looked at.
tss::SceneModel frontalisScene();

/// The skin of the whole head over thirteen muscles, which tighten in turn.
tss::SceneModel faceScene(const Detail& skin = {1.6, 0.4});

/// The left ear laid back until its stiff shell meets the skull, and let go; the skin of the head follows.
tss::SceneModel earsScene();

/// The mouth opens, closes and bites until the teeth meet: lips, cheek and throat ride on skull and mandible,
/// and slide over the teeth.
tss::SceneModel lipsScene();

/// The expressive head: skull, jaw, both ears and all muscles of the face under one skin, which names its
/// bones and nothing else. Calm, alert, a growl, a bite, the ears laid back, and calm again, in six seconds.
tss::SceneModel headScene();

} // namespace doghead
