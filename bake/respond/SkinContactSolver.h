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
    /// Keeps references to both.
    SkinContactSolver(const SkinRig& rig, SkinClock& clock);

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
        SkinPlane plane;
        Eigen::Vector3f place = Eigen::Vector3f::Zero(); ///< its constrained point at that time
        float free = -1; ///< by how much the point may move before the row is queried again; negative: it is
                         ///< violated, and waits for what the push of a deeper one beside it does
    };
    /// A row that was queried and is violated. Of those with the same key the deepest becomes a plane.
    struct Violated {
        std::uint64_t key = 0;
        std::uint32_t row = 0;
        SkinPlane plane;
    };
    void clear();
    void queryAll(const SkinScene& scene);
    float queryDisplaced(const SkinScene& scene);
    void query(const SkinScene& scene, std::uint32_t r);
    SkinPlane timedQuery(const SkinScene& scene, const SkinRow& row);
    void addSatisfied(const SkinScene& scene, std::uint32_t r, const SkinPlane& plane);
    void wait(std::uint32_t r, const Waiting& row);
    bool mayBeViolated(const SkinScene& scene, const Waiting& row) const;
    bool displaced(const SkinPlane& plane) const;
    bool displaced(const SkinRow& row) const;
    std::uint64_t selectionKey(const SkinRow& row, const SkinPlane& plane) const;
    void addPlane(std::uint32_t r, const SkinPlane& plane);
    void addDeepest();
    float deepestViolation() const;

    const SkinRig& rig_;
    SkinClock& clock_;
    SkinPushes pushes_;
    SkinTurnLimit turnLimit_;
    std::vector<SkinPlane> planes_;
    std::vector<SkinPlane> applied_,
        best_;                        ///< planes_ when last applied, and when least was violated after that
    std::vector<std::uint32_t> rows_; ///< row of each of planes_
    std::vector<std::uint32_t> planeOf_; ///< #rows: 1 + the index of its latest in planes_, 0: none
    std::vector<Violated> violated_;
    std::vector<Waiting> waiting_;
    std::vector<std::uint32_t> waitingRows_; ///< row of each of waiting_
    std::vector<std::uint32_t> waitingOf_;   ///< #rows: 1 + its index in waiting_, 0: none
    Lists<std::uint32_t> blockRows_;         ///< per block: rows about its vertices
};

} // namespace tss
