#include "Framing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgTSS {

namespace {

constexpr double around = 35, raised = 25; ///< where the eye is, degrees
constexpr double margin = 1.08;            ///< by which more is in sight than is asked for

} // namespace

Framing::Framing(double aspect) {
    const double right = osg::DegreesToRadians(around), up = osg::DegreesToRadians(raised);
    const osg::Vec3d from(std::sin(right) * std::cos(up), -std::cos(right) * std::cos(up), std::sin(up));
    _turned = osg::Matrixd::lookAt(from, osg::Vec3d(), osg::Vec3d(0, 0, 1));
    _turned.setTrans(0, 0, 0);
    _high = std::tan(osg::DegreesToRadians(fieldOfView / 2)) / margin;
    _wide = _high * aspect;
    _most.fill(-std::numeric_limits<double>::infinity());
}

void Framing::add(const osg::Vec3d& point) {
    if (!point.valid()) return;
    const osg::Vec3d p = point * _turned;
    _most[0] = std::max(_most[0], p.x() + _wide * p.z());
    _most[1] = std::max(_most[1], -p.x() + _wide * p.z());
    _most[2] = std::max(_most[2], p.y() + _high * p.z());
    _most[3] = std::max(_most[3], -p.y() + _high * p.z());
}

// An eye at (x, y, z) sees a point if |p.x - x| <= wide (z - p.z) and |p.y - y| <= high (z - p.z).
osg::Matrixd Framing::view() const {
    if (!std::isfinite(_most[0])) return _turned;
    const double x = (_most[0] - _most[1]) / 2, y = (_most[2] - _most[3]) / 2;
    const double z = std::max((_most[0] + _most[1]) / (2 * _wide), (_most[2] + _most[3]) / (2 * _high));
    return _turned * osg::Matrixd::translate(-x, -y, -z);
}

} // namespace osgTSS
