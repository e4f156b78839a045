// Wang, Wang and Kim, "An algebraic condition for the separation of two ellipsoids", 2001.
#include "bake/compare/Ellipsoid.h"

#include "bake/motion/SmallSystems.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

namespace tss::compare {

namespace {

/// A double that counts its products.
struct Counted {
    double value = 0;
    static thread_local std::uint64_t products;

    Counted() = default;
    Counted(double v) : value(v) {}
    friend Counted operator+(Counted a, Counted b) { return a.value + b.value; }
    friend Counted operator-(Counted a, Counted b) { return a.value - b.value; }
    friend Counted operator-(Counted a) { return -a.value; }
    friend Counted operator*(Counted a, Counted b) { return ++products, a.value * b.value; }
    friend Counted operator/(Counted a, Counted b) { return ++products, a.value / b.value; }
};
thread_local std::uint64_t Counted::products = 0;

double plain(double x) {
    return x;
}
double plain(Counted x) {
    return x.value;
}

int changes(const std::array<double, 5>& values) {
    int count = 0;
    double last = 0;
    for (const double v : values) {
        if (v == 0) continue;
        if (last != 0 && (v < 0) != (last < 0)) ++count;
        last = v;
    }
    return count;
}

/// Number of different positive roots of x^4 + a x^3 + b x^2 + c x + d, d > 0, by Sturm's theorem.
template <class Real>
int positiveRoots(Real a, Real b, Real c, Real d) {
    // p1 = p0' / 4 = x^3 + 3a/4 x^2 + b/2 x + c/4; every remainder may be scaled by a positive number.
    const Real a1 = 0.75 * a, b1 = 0.5 * b, c1 = 0.25 * c;
    // p2 = -(p0 - (x + a/4) p1)
    const Real quarter = 0.25 * a;
    const Real p22 = quarter * a1 + b1 - b, p21 = quarter * b1 + c1 - c, p20 = quarter * c1 - d;
    if (plain(p22) == 0) { // p2 is linear: p3 = -p1 at its root times a positive number
        if (plain(p21) == 0)
            return changes({plain(d), plain(c1), plain(p20), 0, 0}) - changes({1, 1, plain(p20), 0, 0});
        const Real x = -p20 / p21;
        const double p3 = -plain(((x + a1) * x + b1) * x + c1);
        return changes({plain(d), plain(c1), plain(p20), p3, 0}) - changes({1, 1, plain(p21), p3, 0});
    }
    // p3 = -(p1 - (x + s) p2 / p22 ...) with p2 made monic: m1, m0
    const Real inverse = 1.0 / p22, m1 = p21 * inverse, m0 = p20 * inverse;
    const Real s = a1 - m1;
    const Real p31 = s * m1 + m0 - b1, p30 = s * m0 - c1;
    if (plain(p31) == 0)
        return changes({plain(d), plain(c1), plain(p20), plain(p30), 0}) -
               changes({1, 1, plain(p22), plain(p30), 0});
    // p4 = -p2 at the root of p3
    const Real x = -p30 / p31;
    const Real atRoot = (x + m1) * x + m0;
    const double p4 = -plain(atRoot) * (plain(p22) > 0 ? 1 : -1);
    return changes({plain(d), plain(c1), plain(p20), plain(p30), p4}) -
           changes({1, 1, plain(p22), plain(p31), p4});
}

/// What of an ellipsoid does not depend on the sphere: made once.
struct Quadric {
    double scale;              ///< lengths are divided by it: all numbers near 1
    Vec3 alpha;                ///< 1 / radius^2
    Vec3 pairSum, pairProduct; ///< of the other two alphas
    double e1, e2, inverse3;   ///< elementary symmetric; 1 / (product of all)
};

Quadric quadricOf(const BentEllipsoid& ellipsoid) {
    Quadric q;
    q.scale = 1 / std::cbrt(ellipsoid.radii.prod());
    for (int k = 0; k < 3; ++k) q.alpha[k] = 1 / std::pow(ellipsoid.radii[k] * q.scale, 2);
    for (int k = 0; k < 3; ++k) {
        q.pairSum[k] = q.alpha[(k + 1) % 3] + q.alpha[(k + 2) % 3];
        q.pairProduct[k] = q.alpha[(k + 1) % 3] * q.alpha[(k + 2) % 3];
    }
    q.e1 = q.alpha.sum();
    q.e2 = q.pairProduct.sum();
    q.inverse3 = 1 / q.alpha.prod();
    return q;
}

/// f(l) = (k - l) D(l) - sum p_i^2 d_j d_k with d_i = 1 + l alpha_i, D their product, k = |p|^2 - r^2; made
/// monic by -e3, which leaves its roots where they are.
template <class Real>
bool apart(const Quadric& q, const Real (&p)[3], Real radius) {
    const Real square[3] = {p[0] * p[0], p[1] * p[1], p[2] * p[2]};
    const Real r2 = radius * radius;
    const Real k = square[0] + square[1] + square[2] - r2;
    const Real sums = square[0] * q.pairSum[0] + square[1] * q.pairSum[1] + square[2] * q.pairSum[2];
    const Real products =
        square[0] * q.pairProduct[0] + square[1] * q.pairProduct[1] + square[2] * q.pairProduct[2];
    const Real c2 = k * q.e2 - q.e1 - products, c1 = k * q.e1 - 1.0 - sums;
    // c3 = k e3 - e2, c4 = -e3, c0 = -r^2
    return positiveRoots<Real>(Real(q.e2 * q.inverse3) - k, -c2 * q.inverse3, -c1 * q.inverse3,
                               r2 * q.inverse3) == 2;
}

template <class Real>
bool touchesAs(const BentEllipsoid& ellipsoid, const Sphere& sphere) {
    const Quadric q = quadricOf(ellipsoid);
    const Vec3 away = (sphere.centre - ellipsoid.centre) * q.scale;
    const Eigen::Matrix3d& m = ellipsoid.axes;
    Real p[3];
    for (int k = 0; k < 3; ++k)
        p[k] =
            Real(m(0, k)) * Real(away.x()) + Real(m(1, k)) * Real(away.y()) + Real(m(2, k)) * Real(away.z());
    if (ellipsoid.bend != 0) p[1] = p[1] - Real(ellipsoid.bend / q.scale) * (p[0] * p[0]);
    const Vec3 straight(plain(p[0]), plain(p[1]), plain(p[2]));
    // The polynomial cannot tell a sphere of radius 0 inside from one on the border; the centre inside is
    // contact in any case.
    if (straight.cwiseProduct(straight).dot(q.alpha) <= 1) return true;
    return !apart<Real>(q, p, Real(sphere.radius * q.scale));
}

} // namespace

bool touches(const BentEllipsoid& ellipsoid, const Sphere& sphere, std::uint64_t* products) {
    if (!products) return touchesAs<double>(ellipsoid, sphere);
    Counted::products = 0;
    const bool result = touchesAs<Counted>(ellipsoid, sphere);
    *products += Counted::products;
    return result;
}

BentEllipsoid fitEllipsoid(const TriangleMesh& mesh) {
    BentEllipsoid result;
    if (mesh.vertices.empty()) return result;
    Vec3 mean = Vec3::Zero();
    for (const Vec3& v : mesh.vertices) mean += v;
    mean /= static_cast<double>(mesh.vertices.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Vec3& v : mesh.vertices) covariance += (v - mean) * (v - mean).transpose();
    const Eigen::Matrix3d principal = symmetricAxes(covariance);
    Eigen::Matrix3d axes;
    axes.col(0) = principal.col(2); // the longest
    // Least squares of both other coordinates against x^2 gives the direction and size of the bend.
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, 2> right = Eigen::Matrix2d::Zero();
    for (const Vec3& v : mesh.vertices) {
        const double x = axes.col(0).dot(v - mean);
        const Eigen::Vector2d basis(1, x * x);
        const Eigen::Vector2d across(principal.col(1).dot(v - mean), principal.col(0).dot(v - mean));
        normal += basis * basis.transpose();
        right += basis * across.transpose();
    }
    const Eigen::Matrix2d fit = normal.ldlt().solve(right);
    const Vec3 bend = fit(1, 0) * principal.col(1) + fit(1, 1) * principal.col(0);
    result.bend = bend.allFinite() ? bend.norm() : 0;
    axes.col(1) = result.bend > 0 ? Vec3(bend.normalized()) : Vec3(principal.col(1));
    axes.col(2) = axes.col(0).cross(axes.col(1));
    Eigen::AlignedBox3d box;
    for (const Vec3& v : mesh.vertices) {
        Vec3 local = axes.transpose() * (v - mean);
        local.y() -= result.bend * local.x() * local.x();
        box.extend(local);
    }
    result.axes = axes;
    // The middle of the straight box; moving it along the bent axis would tilt the bend, so that stays.
    result.centre = mean + axes.col(1) * box.center().y() + axes.col(2) * box.center().z();
    result.radii = 0.5 * box.sizes();
    result.radii.x() = std::max(-box.min().x(), box.max().x());
    const double least = 1e-9 * result.radii.maxCoeff();
    result.radii = result.radii.cwiseMax(least > 0 ? least : 1e-300);
    return result;
}

} // namespace tss::compare
