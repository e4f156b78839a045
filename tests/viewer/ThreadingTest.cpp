#include "Pictures.h"

#include <catch2/catch.hpp>
#include <osg/DisplaySettings>

namespace {

using Frames = std::vector<std::vector<unsigned char>>;

Frames draw(const std::string& scene, osgViewer::ViewerBase::ThreadingModel model, unsigned int count) {
    osg::ref_ptr<osg::Node> root = pictures::load(scene);
    REQUIRE(root);
    osg::ref_ptr<pictures::Keep> keep = new pictures::Keep;
    {
        const osg::ref_ptr<osgViewer::Viewer> viewer = pictures::makeViewer(*root, model, *keep);
        viewer->realize();
        REQUIRE(viewer->isRealized());
        for (unsigned int frame = 0; frame < count; ++frame) viewer->frame(frame / 24.0);
        viewer->setDone(true);
        viewer->stopThreading();
    }
    return keep->take();
}

/// Four threading models, with and without hints for vertex buffers and vertex array objects: one picture.
void check(const std::string& scene, unsigned int count) {
    if (!pictures::haveDisplay()) {
        WARN("skipped, no display");
        return;
    }
    using osg::DisplaySettings;
    using osgViewer::ViewerBase;
    Frames reference;
    for (const auto hint : {DisplaySettings::NO_PREFERENCE, DisplaySettings::VERTEX_BUFFER_OBJECT,
                            DisplaySettings::VERTEX_ARRAY_OBJECT}) {
        DisplaySettings::instance()->setVertexBufferHint(hint);
        for (const auto model :
             {ViewerBase::SingleThreaded, ViewerBase::CullDrawThreadPerContext,
              ViewerBase::DrawThreadPerContext, ViewerBase::CullThreadPerCameraDrawThreadPerContext}) {
            CAPTURE(scene, hint, model);
            const Frames frames = draw(scene, model, count);
            REQUIRE(frames.size() == count);
            if (reference.empty()) {
                reference = frames;
                CHECK(frames.front() != frames[count / 2]); // something moves
            }
            for (unsigned int k = 0; k < count; ++k) {
                CAPTURE(k);
                CHECK((frames[k] == reference[k]));
            }
        }
    }
    DisplaySettings::instance()->setVertexBufferHint(DisplaySettings::NO_PREFERENCE);
}

} // namespace

TEST_CASE("a deforming skin is the same picture under every threading model and buffer hint") {
    check("dog_frontalis_baked.tss", 20);
}

TEST_CASE("300 frames of a deforming skin are the same pictures", "[.long]") {
    check("dog_frontalis_baked.tss", 300);
}
