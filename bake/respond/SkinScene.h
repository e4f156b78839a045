#pragma once
#include "bake/respond/SkinRig.h"

#include <span>

namespace tss {

/// Where the bodies under a skin stand, and the skin as they carry it. Run-time lengths.
struct SkinScene {
    struct Placed {
        double activation = std::numeric_limits<double>::quiet_NaN(); ///< NaN: not placed yet
        Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();           ///< body to skin
        Eigen::Vector3f shift = Eigen::Vector3f::Zero();
        bool moved = false;          ///< the two are not the identity
        Pose far = Pose::Identity(); ///< of a muscle's insertion against its origin, run-time lengths
        float strain = 0;
        TrackPlace at; ///< of the activation, among the body's nodes

        Eigen::Vector3f toSkin(const Eigen::Vector3f& x) const { return moved ? turn * x + shift : x; }
        Eigen::Vector3f toBody(const Eigen::Vector3f& x) const {
            return moved ? turn.transpose() * (x - shift) : x;
        }
    };
    std::vector<Placed> bodies;
    std::vector<DualPose> frames;              ///< #frames, of those that are not still
    std::vector<bool> still;                   ///< #frames
    std::vector<Move> surface, normals, moves; ///< of the vertices of all bodies, in the bodies' rest frames;
                                               ///< moves: since rest, of muscles by contraction and swelling
    std::vector<char> live;                    ///< #blocks: something below it is not at rest
    std::vector<Move> carried;     ///< #touched: places of the skin as it is carried, without contact
    std::vector<Move> skin;        ///< the same with what contacts have added, then the border's
    std::vector<Move> skinNormals; ///< #touched: those at rest, turned by the bones
    Eigen::Vector3f normalOf(std::size_t v) const { return skinNormals[v].head<3>(); }
};

/// Moves the bodies, and the skin with them: where nothing is live, and was not before, it is left as it is,
/// so what else moves `skin` has to be taken back. activations, poses (motion of each body since rest, in the
/// skin's frame, scene units): one per body, within its range. shift: one a touched vertex, or none, scene
/// units.
void placeBodies(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                 std::span<const Vec3> shift, SkinScene& scene);

} // namespace tss
