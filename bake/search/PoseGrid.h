#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"

namespace tss {

/// A grid of poses over Q through the rest values and the limits, with a mark at each.
class PoseGrid {
public:
    PoseGrid() = default;

    /// As fine as moves no point of B by more than `step`, scene units, from one pose to the next, or in
    /// about `most` poses where that would be more.
    PoseGrid(const Motion& motion, const TriangleMesh& meshB, double step, int most);

    /// No point of B moves by more than `step` from one pose to the next; else that would be too many poses.
    bool fine() const { return fine_; }

    std::size_t rest() const { return rest_; }
    std::vector<double> pose(std::size_t at) const;

    /// One step of one DOF away, inside the limit planes.
    std::vector<std::size_t> neighbours(std::size_t at) const;

    void setFree(std::size_t at) { free_[at] = 1; }
    bool free(std::size_t at) const { return free_[at] != 0; }

    /// The pose nearest to q is free.
    bool freeAround(const std::vector<double>& q) const;

    double share() const; ///< of the poses that are free

private:
    const Motion* motion_ = nullptr;
    std::vector<std::vector<double>> values_; ///< per DOF, rising
    std::size_t rest_ = 0;
    bool fine_ = true;
    std::vector<char> free_;
};

} // namespace tss
