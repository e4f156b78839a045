#pragma once
#include "bake/bind/SkinAttachment.h"

namespace tss {

/// Lets skin that lies on a muscle over several bones go with these as the muscle does there, in place of as
/// it would go by itself, where the two would else come apart by more than skin can give way to
/// (SkinAnatomy::length): by so much it stays behind. Changes the frames' shares only, and of these bones
/// only what they have together: a muscle does not tell how much of its skin goes with others.
void followSpans(const SkinAnatomy& anatomy, const SkinParameters& parameters, SkinAttachment& attachment);

} // namespace tss
