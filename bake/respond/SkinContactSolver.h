#pragma once
#include "bake/respond/SkinCosts.h"
#include "bake/respond/SkinPushes.h"
#include "bake/respond/SkinTurnLimit.h"

namespace tss {

/// Contact resolution: rows are queried, the violated ones become planes that push the skin, and rows are
/// queried again where that has moved it, until no new plane is found. Without history: everything is kept
/// for one push() only.
class SkinContactSolver {
public:
    SkinClock clock;

    /// Keeps a reference to the rig.
    explicit SkinContactSolver(const SkinRig& rig);

    /// Moves all vertices displaced by contacts back to where muscles and bones carry them.
    void undoPushes(SkinScene& scene) { pushes_.undo(scene); }

    /// Pushes the skin of a scene, which must be as muscles and bones carry it. Returns how many planes push.
    std::size_t push(SkinScene& scene);

    /// Largest displacement by the last push(), run-time length; of no meaning where no plane pushes.
    float farthest() const { return pushes_.farthest(); }

    /// Whether contacts may have displaced vertices of a block.
    bool pushed(std::size_t block) const { return pushes_.reaches(block); }

private:
    /// A row that was queried in this update, and of which no plane was made.
    struct Waiting {
        SkinPlane plane; ///< what was found last
        float free = -1; ///< by how much its point may move before the row is queried again; negative: it
                         ///< is violated, and waits for what the push of a deeper one beside it does
        std::uint64_t key = 0; ///< of violated rows with the same key the deepest becomes a plane
    };
    void clear();
    float queryDisplaced(const SkinScene& scene);
    void query(const SkinScene& scene, std::uint32_t r);
    SkinPlane timedQuery(const SkinScene& scene, std::uint32_t r);
    bool mayBeViolated(const SkinScene& scene, const Waiting& row) const;
    bool displaced(const SkinRow& row) const;
    std::uint64_t selectionKey(const SkinPlane& plane) const;
    void addPlane(const SkinPlane& plane);
    void addDeepest();

    const SkinRig& rig_;
    SkinPushes pushes_;
    SkinTurnLimit turnLimit_;
    std::vector<SkinPlane> planes_;
    std::vector<SkinPlane> applied_,
        best_; ///< planes_ when last applied, and when least was violated after that
    std::vector<std::uint32_t> planeOf_; ///< #rows: 1 + the index of its latest in planes_, 0: none
    std::vector<Waiting> waiting_;
    std::vector<std::uint32_t> waitingOf_; ///< #rows: 1 + its index in waiting_, 0: none
    std::vector<std::uint32_t> violated_;  ///< indices into waiting_
    Lists<std::uint32_t> blockRows_;       ///< per block: rows about its vertices
};

} // namespace tss
