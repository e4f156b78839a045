#pragma once
#include "bake/verify/Models.h"
#include "bake/verify/PoseBox.h"

#include <memory>
#include <set>

namespace tss::verify {

/// What is to be shown: wherever the models' gap is <= margin, some test's is <= max(gap, -depth) + epsilon.
/// No tests: the models' gap is never <= margin.
struct Claim {
    std::vector<Test> tests;
    double epsilon = 0, depth = 0, margin = 0;
};

struct BallPair {
    std::int32_t a, b;
};

struct Owed {
    SpherePair pair;
    double contactDistance;
};

/// What is still to be shown in a box and which tests are near.
struct Open {
    std::vector<BallPair> balls;
    std::vector<Owed> pairs;
    std::vector<std::uint32_t> tests;
};

struct Job {
    Box box;
    std::shared_ptr<const Open> open;
};

/// A pair of spheres over a box: y = centre of B's minus centre of A's.
struct Apart {
    Vec3 y;
    double distance = 0;
    double contactDistance = 0;
    const MovingPoint* b = nullptr;
    SpherePair pair;
    std::vector<double> slope; ///< of |y|^2 / 2

    double gap() const { return distance - contactDistance; }
    double tilt(const PoseBox& box) const;
    /// Bounds of |y|^2 over the box; the last factors are the bounds' own rounding.
    double leastSquare(const PoseBox& box) const;
    double largestSquare(const PoseBox& box) const;
};

/// Looks at boxes of Q for one claim: whether it is shown all over the box, broken at a pose in it, or what
/// is left for two halves. Holds scratch memory: one for each thread.
class BoxProver {
public:
    BoxProver(const Models& models, const Claim& claim);

    Outcome judge(const Job& job, std::vector<Job>& halves, VerifyResult& broken);

private:
    struct Moved : MovingPoint {
        std::uint64_t stamp = 0;
        bool full = false;
    };

    const Moved& moved(const PoseBox& box, std::size_t ball, bool full);

    static Apart apart(const PoseBox& box, const MovingPoint& b, const Vec3& centreA, double contactDistance,
                       SpherePair pair);

    /// True: one test answers for everything in the box.
    bool weighTests(const PoseBox& box, const Open& open);

    void weigh(const PoseBox& box, const Owed& o);

    void openBalls(const PoseBox& box, const std::vector<BallPair>& from);

    bool answered(const PoseBox& box, const Apart& p);

    /// Wherever p owes an answer in the box, test k gives it. Two ways to see it, both about h = |y_k|^2 -
    /// weight |y_p|^2: p in contact implies k in contact (yes/no), or k is nearer than p less the difference
    /// of distances at contact.
    bool answers(const PoseBox& box, const Apart& k, const Apart& p) const;

    /// An upper bound of |y_k|^2 - slope |y_p|^2 where the linear part of p's square counts `slope` times and
    /// its quadratic part `curve` times.
    double largest(const PoseBox& box, const Apart& k, const Apart& p, double slope, double curve) const;

    /// Looks for a pose in the box that breaks the claim: the middle, and where the deepest pair is deepest.
    bool breaks(const PoseBox& box, VerifyResult& broken) const;

    bool breaksAt(const std::vector<double>& q, VerifyResult& broken) const;

    void split(const Job& job, const PoseBox& box, std::vector<Job>& halves) const;

    const Models& m_;
    const Claim& claim_;
    std::set<SpherePair> exact_;
    std::vector<std::size_t> leafOf_;
    double smallest_;

    std::uint64_t stamp_ = 0;
    std::vector<Moved> moved_;
    std::vector<MovingPoint> points_;
    std::vector<Apart> near_, owed_;
    std::vector<std::uint32_t> numbers_;
    std::vector<BallPair> balls_;
};

} // namespace tss::verify
