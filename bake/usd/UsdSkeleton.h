#pragma once
#include "bake/robot/Character.h"
#include "bake/scene/SceneParts.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tss {

/// All numbers of a value, whatever tuples they stand in. Throws InputError for what is no number, or not
/// finite.
std::vector<double> numbersIn(const Value& value);

/// Matrices of row vectors, of numbers as they stand in the file. Throws InputError for one that is not
/// affine.
Eigen::Affine3d affineOf(const double* numbers);

/// A Skeleton: its joints, and their places in the skeleton.
struct UsdSkeleton {
    std::vector<std::string> joints;    ///< paths in the skeleton, as "Hip/Knee"
    std::vector<int> parents;           ///< each before its children; -1: none
    std::vector<Eigen::Affine3d> bound; ///< bindTransforms
    std::vector<Eigen::Affine3d> rest;  ///< restTransforms, each in its parent; without any those of bound

    std::map<std::string, int> indices() const;
    /// From places in parents to places in the skeleton.
    std::vector<Eigen::Affine3d> composed(const std::vector<Eigen::Affine3d>& local) const;
};

/// Throws InputError, or adds to the reader's problems.
UsdSkeleton readUsdSkeleton(const PrimReader& prim);

/// A SkelAnimation of a skeleton.
class UsdAnimation {
public:
    /// Throws InputError, or adds to the reader's problems.
    UsdAnimation(const PrimReader& prim, const UsdSkeleton& skeleton);

    /// Of all samples; none: the same pose at all times.
    std::vector<double> times() const;
    /// Of each joint of the skeleton in its parent; where the animation does not move it, at rest.
    std::vector<Eigen::Affine3d> localAt(double time) const;
    /// Joints that the skeleton does not have.
    const std::vector<std::string>& unknown() const { return unknown_; }

private:
    /// An attribute of all joints that are moved; linear between samples, as USD has it, slerp of rotations.
    struct Samples {
        std::vector<double> times;
        std::vector<std::vector<double>> values; ///< one of each time, or one alone
        bool any() const { return !values.empty(); }
    };
    Samples samplesOf(const PrimReader& prim, const char* name, std::size_t width) const;
    static std::vector<double> at(const Samples& samples, double time, bool turns);

    const UsdSkeleton& skeleton_;
    std::vector<int> jointOf_; ///< of each joint of the animation, that of the skeleton; -1: none
    std::vector<std::string> unknown_;
    Samples translations_, rotations_, scales_;
};

} // namespace tss
