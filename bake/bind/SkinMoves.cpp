#include "bake/bind/SkinMoves.h"

#include "bake/bind/SkinAttachment.h"
#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleTrack.h"

namespace tss {
namespace {

/// Adds to `most`, #V displacements, the largest swelling of a muscle over several bones over all swings.
void addSwelling(const MuscleDeformer& muscle, std::span<const int> chain, std::size_t m,
                 const std::vector<BoneSwing>& swings, std::vector<double>& most) {
    if (chain.empty()) return;
    const MuscleSpan span(muscle);
    double swell = 0;
    for (const BoneSwing& swing : swings)
        for (const std::vector<Pose>& station : swing)
            swell = std::max(swell, std::abs(span.swell(chainMotion(station, m, chain),
                                                        muscle.muscle().surface.vertices)));
    for (std::size_t v = 0; v < most.size(); ++v) most[v] += swell * span.swelling()[v].norm();
}

} // namespace

SkinMoves skinMoves(const TriangleMesh& skin,
                    const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                    const SkinParameters& parameters) {
    checkSkin(skin, bodies.size(), parameters);
    SkinMoves moves;
    moves.stray.assign(bodies.size(), std::vector<double>(skin.vertices.size(), 0));
    moves.shares = moves.stray;
    const SkinAnatomy anatomy(skin, bodies, parameters);
    const std::vector<int> frames = framesOf(anatomy, parameters);
    const SkinAttachment attachment = attachSkin(anatomy, parameters);
    std::vector<bool> taken(attachment.frames.size(), false);
    for (std::size_t m = 0; m < bodies.size(); ++m)
        if (frames[m] >= 0 && !taken[frames[m]]) {
            taken[frames[m]] = true;
            moves.shares[m] = attachment.frames[frames[m]];
        }
    for (std::size_t m = 0; m < bodies.size(); ++m) {
        if (attachment.muscles[m].empty()) continue;
        const Muscle& muscle = bodies[m]->muscle();
        std::vector<double> most(muscle.surface.vertices.size(), 0);
        for (const double node : activationNodes(muscle.activationLower, muscle.activationUpper, bodySteps)) {
            const std::vector<Vec3> now = bodies[m]->vertices(node);
            for (std::size_t v = 0; v < most.size(); ++v)
                most[v] = std::max(most[v], (now[v] - muscle.surface.vertices[v]).norm());
        }
        addSwelling(*bodies[m], chainOf(parameters, m), m, parameters.swings, most);
        for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
            if (!(attachment.muscles[m][v] > 0)) continue;
            double moved = 0;
            for (const int corner : muscle.surface.triangles[attachment.bindings[m][v].triangle])
                moved = std::max(moved, most[corner]);
            for (std::size_t other = 0; other < bodies.size(); ++other)
                if (other != m) moves.stray[other][v] += attachment.muscles[m][v] * moved;
        }
    }
    return moves;
}

} // namespace tss
