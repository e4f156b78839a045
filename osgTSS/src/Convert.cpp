#include "bake/motion/SmallSystems.h"

#include <osgTSS/Convert>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace osgTSS {

osg::Vec3d toOsg(const tss::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

tss::Vec3 toCore(const osg::Vec3d& v) {
    return {v.x(), v.y(), v.z()};
}

osg::Matrixd toOsg(const tss::Pose& pose) {
    osg::Matrixd matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) matrix(column, row) = pose.matrix()(row, column);
    return matrix;
}

std::optional<Similarity> toSimilarity(const osg::Matrixd& matrix, double share) {
    Eigen::Matrix3d linear;
    tss::Vec3 translation;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) linear(row, column) = matrix(column, row);
        translation[row] = matrix(3, row);
        if (!(std::abs(matrix(row, 3)) <= 1e-9)) return std::nullopt;
    }
    if (!(std::abs(matrix(3, 3) - 1) <= 1e-9) || !linear.allFinite() || !translation.allFinite())
        return std::nullopt;
    Similarity result;
    result.pose.translation() = translation;
    const Eigen::Matrix3d square = linear.transpose() * linear;
    if ((square - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() == 0 && linear.determinant() > 0) {
        result.pose.linear() = linear; // exact already: keep the bits
        return result;
    }
    const tss::SingularValues svd = tss::singularValues(linear);
    const tss::Vec3& scales = svd.values;
    if (!(scales[2] > 0) || scales[0] - scales[2] > share * scales[0]) return std::nullopt;
    const Eigen::Matrix3d rotation = svd.u * svd.v.transpose();
    const double hand = rotation.determinant() < 0 ? -1 : 1;
    result.pose.linear() = hand * rotation;
    const double scale = scales.mean();
    result.off = (scales[0] - scales[2]) / scales[0];
    result.scale = hand * (std::abs(scale - 1) < std::max(1e-6, result.off) ? 1 : scale);
    return result;
}

osg::ref_ptr<osg::Vec3Array> toOsg(std::span<const tss::Vec3> points) {
    osg::ref_ptr<osg::Vec3Array> array = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, points.size());
    copyTo(*array, points);
    return array;
}

void copyTo(osg::Vec3Array& array, std::span<const tss::Vec3> points) {
    assert(array.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) array[i] = osg::Vec3(toOsg(points[i]));
}

osg::Vec4 toDisplayColor(const tss::Vec3& linear) {
    const auto curve = [](double c) {
        return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
    };
    return {curve(linear.x()), curve(linear.y()), curve(linear.z()), 1};
}

tss::Vec3 toLinearColor(const osg::Vec4& display) {
    const auto curve = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return {curve(display.x()), curve(display.y()), curve(display.z())};
}

} // namespace osgTSS
