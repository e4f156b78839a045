#pragma once
#include "bake/motion/Motion.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// How bones turn each vertex of a skin: where several hold it, or one holds it partly, the blend of their
/// rotations. What a skin keeps (directions of edges, normals, shapes of triangles) is turned by it.
class SkinTurn {
public:
    /// No vertex is turned.
    void clear() { turns_.clear(); }
    bool none() const { return turns_.empty(); }

    /// Adds a rotation to #vertices turns: vertex[k] is turned by share[k] of it, all shares of a vertex
    /// together at most 1. normalise() when all are there.
    void add(std::size_t vertices, std::uint32_t vertex, double share, const Eigen::Quaterniond& rotation) {
        if (none()) turns_.resize(vertices, Eigen::Quaterniond::Identity());
        const double sign = rotation.w() < 0 ? -1 : 1;
        turns_[vertex].coeffs() +=
            share * (sign * rotation.coeffs() - Eigen::Quaterniond::Identity().coeffs());
    }
    void normalise() {
        for (Eigen::Quaterniond& q : turns_)
            q = q.norm() > 0 ? q.normalized() : Eigen::Quaterniond::Identity();
    }

    Eigen::Quaterniond of(std::uint32_t vertex) const {
        return none() ? Eigen::Quaterniond::Identity() : turns_[vertex];
    }
    /// What turns with a vertex.
    Vec3 turned(std::uint32_t vertex, const Vec3& x) const { return none() ? x : turns_[vertex] * x; }
    /// The mean over some vertices.
    Eigen::Quaterniond of(std::span<const std::uint32_t> vertices) const {
        if (none()) return Eigen::Quaterniond::Identity();
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (const std::uint32_t v : vertices) sum += turns_[v].coeffs();
        return sum.norm() > 0 ? Eigen::Quaterniond(sum.normalized()) : turns_[vertices.front()];
    }

private:
    std::vector<Eigen::Quaterniond> turns_; ///< #vertices, w >= 0; empty: none is turned
};

} // namespace tss
