#pragma once
#include <osg/Matrixd>
#include <osg/Vec3d>

#include <array>

namespace osgTSS {

constexpr double fieldOfView = 30; ///< of pictures, from bottom to top, degrees

/// The view from the front, from the right and from above, so that neither a plate nor a hinge along an axis
/// is seen on edge: so near that all points are just in sight.
class Framing {
public:
    /// `aspect`: width by height of the picture.
    explicit Framing(double aspect);

    void add(const osg::Vec3d& point);
    /// World to eye; of no points, something.
    [[nodiscard]] osg::Matrixd view() const;

private:
    osg::Matrixd _turned; ///< world to eye, without the eye's place
    double _wide, _high;  ///< half of what is seen at distance 1, less a margin
    /// Of all points p in _turned: the greatest x, -x, y and -y, each plus how much wider the picture is
    /// there.
    std::array<double, 4> _most;
};

} // namespace osgTSS
