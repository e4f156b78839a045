#pragma once
#include "Framing.h"

#include <osg/AnimationPath>
#include <osg/Image>
#include <osgViewer/Viewer>

#include <array>
#include <optional>

namespace osgTSS {

constexpr double framesPerSecond = 24;

/// How pictures are taken.
struct Shot {
    int width = 800, height = 600;
    int finer = 2; ///< pixels drawn along each side of one, and averaged
    osg::Vec4 background{0.16f, 0.18f, 0.22f, 1};
    osg::ref_ptr<osg::AnimationPath>
        view; ///< eye to world over seconds, 24 frames in each; null: from a place
    std::optional<std::array<osg::Vec3d, 2>>
        place;                ///< eye and what it looks at; none: aslant from the front, all in sight
    Framing framing{4.0 / 3}; ///< of the default view: what the motion reaches beyond the beginning
    bool framed = false;      ///< and the beginning too: what else is shown need not be in sight
};

/// A viewer without a window, in the OpenGL context that is current in this thread: one time code a frame,
/// drawn into an image.
class OffscreenViewer {
public:
    OffscreenViewer(osg::Node& scene, const Shot& shot);

    /// Frames from 0 upwards, each once, by either. The image is written over by the next one.
    const osg::Image& draw(unsigned int frame);
    /// Moves the scene on, without a picture.
    void pass(unsigned int frame);

private:
    void look(unsigned int frame);
    void average();

    Shot _shot;
    osg::ref_ptr<osgViewer::Viewer> _viewer = new osgViewer::Viewer;
    osg::ref_ptr<osg::Image> _drawn = new osg::Image; ///< finer
    osg::ref_ptr<osg::Image> _image = new osg::Image;
};

} // namespace osgTSS
