#pragma once
#include "bake/respond/SkinPushes.h"

#include <span>

namespace tss {

/// What an update did.
struct SkinUpdate {
    bool moved = false;       ///< positions or normals changed since the last update
    bool rest = false;        ///< the skin is exactly as modelled
    std::size_t contacts = 0; ///< planes that push
};

/// A skin that follows its muscles and bones (METHOD 6.5). One instance a skin on the screen; the rig is
/// shared.
///
///     auto rig = makeSkinRig(skinMesh, bodies, table, parameters);    // at load
///     SkinResponse response(rig);
///     response.update(activations, poses);                            // each update traversal
///     for k: mesh.vertices[rig->vertices[k]] = response.positions()[k], and the same for normals()
///
/// Quasi-static: no time step, no velocity, and no history: the skin is a function of the activations and
/// poses alone, the same bits whatever came before. With all activations 0 and all poses the identity it is
/// exactly at rest. Nothing is allocated any more once its lists have grown to what the motion asks for. Not
/// thread-safe: one thread an instance.
class SkinResponse {
public:
    explicit SkinResponse(std::shared_ptr<const SkinRig> rig);

    /// activations: one a body in the rig's order, missing ones count as 0, clamped to each one's range.
    /// poses: motion of each body (its bone) since rest, in the skin's frame; empty: none moves.
    SkinUpdate update(std::span<const double> activations, std::span<const Pose> poses = {});

    /// Of the touched vertices, rig().vertices: places in the skin's frame, and unit normals.
    std::span<const Vec3> positions() const { return positions_; }
    std::span<const Vec3> normals() const { return normals_; }

    const SkinRig& rig() const { return *rig_; }

    /// Largest change of a place in the last sweep of the last update, scene units: how far from converged it
    /// is.
    double residual() const { return residual_; }

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
    std::uint64_t placeOfChoice(const SkinRow& row, const SkinPlane& plane) const;
    Seen seen(const SkinRow& row, const SkinPlane& plane) const;
    bool mayPush(std::uint32_t r) const;
    void findStirred();
    bool stirred(std::uint32_t r) const;
    void toRest();
    void addDeepest();
    void resist();
    void findNormals();

    std::shared_ptr<const SkinRig> rig_;
    SkinScene scene_;
    SkinPushes pushes_;
    std::vector<SkinPlane> planes_;
    std::vector<std::uint32_t> rows_;    ///< of planes_
    std::vector<std::uint32_t> planeOf_; ///< #rows: 1 + its place in planes_, 0: none
    std::vector<Found> found_;
    std::vector<Seen> seen_;
    std::vector<std::uint32_t> seenRows_; ///< of seen_
    std::vector<std::uint32_t> seenOf_;   ///< #rows: 1 + its place in seen_, 0: none
    std::vector<Move> start_;             ///< the skin as it is carried
    std::vector<char> stirred_;           ///< #touched: contacts have moved it
    std::vector<char> lacking_;           ///< #rows: when last looked up, another one was chosen
    std::vector<Vec3> positions_, normals_;
    std::vector<Move> normalSums_;
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    double residual_ = 0;
    std::size_t contacts_ = 0;
    bool atRest_ = true;
};

} // namespace tss
