#pragma once
#include "bake/table/DofFactors.h"
#include "bake/table/Kernels.h"
#include "bake/table/TablePairs.h"

#include <Eigen/Core>

namespace tss {

/// Squared distances of all pairs as a product of a matrix with a few features of the joint's values
/// (METHOD 4): d^2 = constants + weights * features + shared. Features are products of one factor a DOF
/// (DofFactor), less their values where the bodies are near contact; a feature that weighs the same in every
/// pair (|t|^2 of a slide) is in `shared`.
struct FeatureForm {
    static constexpr int maxDofs = 3; ///< 3^d products: beyond, the direct kernel is the cheaper one
    static constexpr int maxFeatures = maxFoldFeatures; ///< likewise (METHOD 4, two kernels)

    struct Feature {
        std::array<std::uint8_t, maxDofs> factor{}; ///< per DOF: 0 none, 1 first, 2 second
        double centre = 0;                          ///< subtracted
        double range = 0;                           ///< largest |feature - centre| over the limits
    };

    std::vector<DofFactor> factors; ///< one per DOF
    std::vector<Feature> features;  ///< those that weigh most first
    std::vector<Feature> sharedFeatures;
    std::vector<double> sharedWeights;
    Eigen::MatrixXd weights;   ///< #pairs by #features
    Eigen::VectorXd constants; ///< #pairs: d^2 where all features are 0
    Eigen::VectorXd dropped;   ///< #pairs: bound of what columns too small to keep leave out, and of how far
                               ///< weights and constants are off for having been worked out with roundoffs

    double sharedRange() const;

    /// What a query reads, at q: first less the shared term, then the features. out: #features + 1 values,
    /// float or double. Allocates nothing.
    template <class T>
    void evaluate(const double* q, T* out) const;

    /// Bounds of the rounding error of d^2 - contactDistance^2 (where that is about 0) and of d^2 (for
    /// distances about `distance`), of one pair.
    double signError(double u, Eigen::Index pair, double contactDistance) const;
    double squareError(double u, Eigen::Index pair, double distance) const;

private:
    double rangeError(double u, Eigen::Index pair) const;
};

/// The fold of pairs over a motion, or nothing where there is none that pays: paths, too many DOFs, more
/// than maxFeatures features. `contacts`: poses near contact, to centre features at; may be empty. Adds to
/// `*multiplied` how many pairs were multiplied out.
std::optional<FeatureForm> makeFeatureForm(const Motion& motion, std::span<const TablePair> pairs,
                                           std::span<const std::vector<double>> contacts,
                                           std::uint64_t* multiplied = nullptr);

/// The largest difference of the fold's squared distances from T(q)'s over some poses (METHOD 4: check
/// against T(q)).
double featureFormMismatch(const FeatureForm& form, const Motion& motion, std::span<const TablePair> pairs,
                           std::span<const std::vector<double>> poses);

} // namespace tss
