#pragma once
#include "bake/respond/SkinRig.h"

#include <optional>
#include <span>

namespace tss {

/// The state of bodies and skin at one update, run-time lengths: bodies placed, the skin deformed by them,
/// and the skin after contact.
struct SkinScene {
    struct Placed {
        double activation = std::numeric_limits<double>::quiet_NaN(); ///< NaN: not placed yet
        Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();           ///< body to skin, rotation
        Eigen::Vector3f shift = Eigen::Vector3f::Zero();              ///< body to skin, translation
        bool moved = false;                                           ///< turn and shift are not the identity
        ChainMotion bones;                                            ///< of a muscle over several
        TrackPlace at; ///< interpolation of the activation between the body's nodes

        Eigen::Vector3f toSkin(const Eigen::Vector3f& x) const { return moved ? turn * x + shift : x; }
        Eigen::Vector3f toBody(const Eigen::Vector3f& x) const {
            return moved ? turn.transpose() * (x - shift) : x;
        }
        /// Of directions.
        Eigen::Vector3f turned(const Eigen::Vector3f& x) const { return moved ? turn * x : x; }
        Eigen::Vector3f turnedBack(const Eigen::Vector3f& x) const {
            return moved ? turn.transpose() * x : x;
        }
    };
    std::vector<Placed> bodies;
    std::vector<Pose> local;                     ///< #bodies: motions since rest, run-time lengths
    std::vector<std::optional<DualPose>> frames; ///< #frames: motion since rest; none: at rest
    bool turned = false;                         ///< some frame is not at rest
    std::vector<Move> surface;                   ///< vertices of all bodies, in the bodies' rest frames
    std::vector<Move> normals;                   ///< of these vertices, unit
    std::vector<Move> moves;       ///< displacement of these vertices since rest by contraction and swelling
    std::vector<char> live;        ///< #blocks: something that moves it is not at rest
    std::vector<Move> carried;     ///< #touched: skin as muscles and bones carry it, before contact
    std::vector<Move> skin;        ///< #touched: skin after contact; then the border's vertices, and one more
    std::vector<Move> skinNormals; ///< #touched: normals at rest, rotated with the bones
    Eigen::Vector3f normalOf(std::size_t v) const { return skinNormals[v].head<3>(); }
};

/// Places the bodies and deforms the skin by them. Blocks that are not live, and were not before, are left as
/// they are, so that displacements by contact must be undone first. activations, within their ranges, and
/// poses (motion since rest, in the skin's frame, scene units): one per body. shift: one per touched vertex,
/// or none, scene units.
void placeBodies(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                 std::span<const Vec3> shift, SkinScene& scene);

/// How bones have turned the skin at a touched vertex since rest.
Eigen::Matrix3f turnOf(const SkinRig& rig, const SkinScene& scene, std::size_t v);

} // namespace tss
