#pragma once
#include "bake/respond/SkinCosts.h"
#include "bake/respond/SkinPushes.h"

namespace tss {

/// The skin leaves what it is carried into: rows of contact are looked up, those that lack something push,
/// and where that has moved the skin to they are looked up again. Without history: what is kept is kept
/// within one push().
class SkinResistance {
public:
    /// Keeps references to both.
    SkinResistance(const SkinRig& rig, SkinClock& clock);

    /// What contacts have moved goes back to where it is carried.
    void takeBack(SkinScene& scene);

    /// Moves the skin of a scene as it is carried. Returns how many planes push.
    std::size_t push(SkinScene& scene);

    /// How far the last push() moved skin at most from where it is carried; of no meaning where none pushes.
    float farthest() const { return farthest_; }

    /// Whether contacts may have moved vertices of a block.
    bool pushed(std::size_t block) const { return pushed_[block] != 0; }

private:
    /// A row that was looked up in this update and lacks nothing: not before it has come nearer by this much.
    struct Seen {
        SkinPlane plane;
        Eigen::Vector3f place; ///< of what the plane holds, then
        float free = 0;
    };
    /// A row that lacks something, and where: of each place the deepest is chosen.
    struct Found {
        std::uint64_t place = 0;
        std::uint32_t row = 0;
        SkinPlane plane;
    };
    void clear();
    void lookUpFirst(const SkinScene& scene);
    float lookUpAgain(const SkinScene& scene);
    void lookAt(const SkinScene& scene, std::uint32_t r);
    SkinPlane timedLookUp(const SkinScene& scene, const SkinRow& row);
    void see(const SkinScene& scene, std::uint32_t r, const SkinPlane& plane);
    bool moved(const SkinScene& scene, const Seen& seen) const;
    bool mayPush(const SkinScene& scene, std::uint32_t r) const;
    bool stirred(const SkinPlane& plane) const;
    bool stirred(const SkinRow& row) const;
    void findStirred(const SkinScene& scene);
    std::uint64_t placeOfChoice(const SkinRow& row, const SkinPlane& plane) const;
    void addDeepest();
    std::size_t apply(SkinScene& scene, std::span<const SkinPlane> planes);
    float deepestFound() const;

    const SkinRig& rig_;
    SkinClock& clock_;
    SkinPushes pushes_;
    std::vector<SkinPlane> planes_;
    std::vector<SkinPlane> applied_, best_; ///< planes_ as they pushed last, and where least was lacking then
    std::vector<std::uint32_t> rows_;       ///< of planes_
    std::vector<std::uint32_t> planeOf_;    ///< #rows: 1 + its place in planes_, 0: none
    std::vector<Found> found_;
    std::vector<Seen> seen_;
    std::vector<std::uint32_t> seenRows_; ///< of seen_
    std::vector<std::uint32_t> seenOf_;   ///< #rows: 1 + its place in seen_, 0: none
    std::vector<char> pushed_;            ///< #blocks: with vertices that contacts may have moved
    std::vector<char> stirred_;           ///< #touched: contacts have moved it
    std::vector<std::uint32_t> left_;  ///< rows that lacked something when last looked up; another was chosen
    std::vector<char> isLeft_;         ///< #rows
    std::vector<std::uint32_t> asked_; ///< #rows: at which look by its block it was last asked
    std::uint32_t looks_ = 0;
    float farthest_ = 0;             ///< of what contacts have moved, from where it is carried
    Lists<std::uint32_t> blockRows_; ///< of each block those about its vertices
};

} // namespace tss
