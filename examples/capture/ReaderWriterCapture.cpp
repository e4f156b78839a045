#include "bake/base/FramePattern.h"

#include <osg/Camera>
#include <osg/GraphicsContext>
#include <osg/Group>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <sstream>
#include <string>

namespace {

/// Reads the finished frame back and writes it, every so many frames.
class SaveFrame : public osg::Camera::DrawCallback {
public:
    SaveFrame(const std::string& pattern, unsigned every) : pattern_(pattern), every_(every) {}

    void operator()(osg::RenderInfo& info) const override {
        const osg::FrameStamp* stamp = info.getState()->getFrameStamp();
        const osg::GraphicsContext* window = info.getState()->getGraphicsContext();
        if (!stamp || !window || !window->getTraits() || stamp->getFrameNumber() % every_ != 0) return;
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->readPixels(0, 0, window->getTraits()->width, window->getTraits()->height, GL_RGB,
                          GL_UNSIGNED_BYTE);
        const std::string name = tss::frameName(pattern_, stamp->getFrameNumber());
        if (!osgDB::writeImageFile(*image, name)) OSG_WARN << "capture: cannot write " << name << std::endl;
    }

private:
    std::string pattern_;
    unsigned every_;
};

/// FILE.capture: FILE as its own plugin reads it, and each frame drawn of it is saved as a picture. Options,
/// as words in the option string (osgviewer -O):
///     capture=DIR/f_%04d.png   where to, with the number of the frame; any format OSG writes
///     every=N                  only frames whose number N divides
/// A viewer that runs one time code a frame (clock=frame of .tss) shows the same states in the same files
/// each time.
class ReaderWriterCapture : public osgDB::ReaderWriter {
public:
    ReaderWriterCapture() {
        supportsExtension("capture", "Pseudo-loader that saves the frames drawn");
        supportsOption("capture=PATTERN", "Where pictures go, with %04d for the frame number");
        supportsOption("every=N", "Only every N-th frame");
    }

    const char* className() const override { return "Frame capture pseudo-loader"; }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        std::string pattern = "frame_%04d.png";
        unsigned every = 1;
        std::istringstream words(options ? options->getOptionString() : "");
        for (std::string word; words >> word;) {
            if (word.rfind("capture=", 0) == 0) pattern = word.substr(8);
            if (word.rfind("every=", 0) == 0 && !(std::istringstream(word.substr(6)) >> every)) every = 0;
        }
        if (every == 0 || !tss::isFramePattern(pattern)) {
            OSG_WARN << "capture: expected every=N with N at least 1 and a pattern with one %d, found every="
                     << every << " capture=" << pattern << std::endl;
            return ReadResult::ERROR_IN_READING_FILE;
        }
        osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(osgDB::getNameLessExtension(file), options);
        if (!model) return ReadResult::FILE_NOT_FOUND;

        // Drawn after all else, and drawing nothing itself.
        osg::ref_ptr<osg::Camera> last = new osg::Camera;
        last->setRenderOrder(osg::Camera::POST_RENDER, 10000);
        last->setReferenceFrame(osg::Transform::ABSOLUTE_RF_INHERIT_VIEWPOINT);
        last->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        last->setClearMask(0);
        last->setCullingActive(false);
        last->setAllowEventFocus(false);
        last->setDataVariance(osg::Object::DYNAMIC); // else the optimizer takes it for an empty group
        last->setPostDrawCallback(new SaveFrame(pattern, every));

        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(model);
        root->addChild(last);
        return root.release();
    }
};

} // namespace

REGISTER_OSGPLUGIN(capture, ReaderWriterCapture)
