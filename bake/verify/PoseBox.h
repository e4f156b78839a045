#pragma once
#include "bake/motion/MotionBound.h"

namespace tss::verify {

/// A box of DOF values.
struct Box {
    std::vector<double> lower, upper;
    double middle(std::size_t k) const { return lower[k] + 0.5 * (upper[k] - lower[k]); }
    /// Cut across DOF k: the lower one, the upper one.
    std::array<Box, 2> halves(std::size_t k, double at) const;
};

/// What looking at a box gave: all is shown; a cut is needed; a pose of it breaks what is claimed, or cannot
/// be told from one that does.
enum class Outcome { Shown, Split, Broken, Undecided };

/// The box of the limits.
Box limitsOf(const Motion& motion);

/// Some pose of the box may be inside all limit planes.
bool meetsPlanes(const Motion& motion, const Box& box);

/// DOF values spread over the limits, planes not looked at: a low-discrepancy sequence. onLimits: the share
/// of each range at either end that falls on the limit.
std::vector<std::vector<double>> spreadOverLimits(const Motion& motion, int count, double onLimits = 0);

/// Where a point of B is at the middle of a box and how it may move while q stays in the box. Everything
/// includes its own rounding error.
struct MovingPoint {
    Vec3 at = Vec3::Zero();
    double move = 0; ///< never farther than this from `at`
    double bend = 0; ///< never farther than this from at + velocity . (q - middle); infinite across knots
    std::array<Vec3, maxDofs> velocity; ///< one per DOF, at the middle; of those asked for
    std::array<double, maxDofs> sweep;  ///< one per DOF: what it adds to `move` at most
};

/// The rigid motion over one box, worked out by carrying points through the chain DOF by DOF.
class PoseBox {
public:
    /// `size`: no coordinate on the way is larger than this.
    PoseBox(const Motion& motion, const Box& box, double size);

    /// Where a point of B, given in B's frame, goes. velocities: fill those too.
    MovingPoint carry(const Vec3& y, bool velocities) const;

    double half(std::size_t k) const { return links_[k].half; }
    std::size_t dofs() const { return links_.size(); }
    const std::vector<double>& middle() const { return middle_; }

    /// A vector fixed in B, of length 1, changes by no more than `turn`, and differs from its linear part by
    /// no more than `turnBend`.
    double turn() const { return turn_; }
    double turnBend() const { return turnBend_; }

    /// T(q) at the middle, to within error().
    const Pose& pose() const { return pose_; }
    /// How fast a DOF turns B at the middle, in A's frame: a point at x, fixed in B, has the velocity of
    /// another at y and spin x (x - y) more.
    const Vec3& spin(std::size_t k) const { return spins_[k]; }
    /// What rounding may do to a point that is carried, scene units; in every bound already.
    double error() const { return error_; }

    /// Where to cut the box along a DOF: at the knot of a path nearest to the middle, if one is inside.
    double cut(std::size_t k) const { return links_[k].cut; }

private:
    struct Link {
        Pose pose;         ///< D(q) at the middle
        Vec3 spin, centre; ///< angular rate and a point on the axis, in the frame that D maps into
        Vec3 slide;        ///< linear rate
        double half = 0;
        double spinRate = 0, slideRate = 0; ///< largest in the box
        double chord = 0;                   ///< at radius 1, of the largest turn from the middle
        bool bent = false;                  ///< a knot of a path lies inside
        double cut = 0;
    };
    Link makeLink(const Dof& dof, double lower, double upper, double middle) const;
    void addPath(Link& link, const Dof& dof, double lower, double upper, double middle) const;

    Pose base_;
    std::vector<Link> links_;
    std::vector<double> middle_;
    double error_;
    double turn_ = 0, turnBend_ = 0;
    Pose pose_;
    std::array<Vec3, maxDofs> spins_;
};

/// A bound for every coordinate that a point of B with |y| <= reach meets on its way into A's frame.
double coordinateBound(const Motion& motion, double reach);

} // namespace tss::verify
