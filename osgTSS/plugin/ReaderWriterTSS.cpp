#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>
#include <osgTSS/SceneFile>

#include <exception>
#include <sstream>

namespace {

/// Reads and writes .tss scenes. What goes wrong comes back as the message of the result, with file, JSON
/// pointer and prim path.
class ReaderWriterTSS : public osgDB::ReaderWriter {
public:
    ReaderWriterTSS() {
        supportsExtension("tss", "Tabulated sphere subset scene");
        supportsOption("clock=<frame|time>", "One time code a frame, or simulation time (default)");
        supportsOption("light=<on|off>", "The scene's own key light (default on)");
        supportsOption("noRotation", "Leave a scene with Y up as it is");
        supportsOption("overlay",
                       "Show spheres, tested pairs and contacts from the start; key 'x' hides them");
    }

    const char* className() const override { return "Tabulated sphere subset reader/writer"; }

    ReadResult readObject(const std::string& file, const Options* options) const override {
        return readNode(file, options);
    }
    ReadResult readObject(std::istream& stream, const Options* options) const override {
        return readNode(stream, options);
    }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        const std::string found = osgDB::findDataFile(file, options);
        if (found.empty()) return readBaked(file, options);
        return guarded([&] { return osgTSS::readScene(found); }, options, found);
    }

    ReadResult readNode(std::istream& stream, const Options* options) const override {
        return guarded(
            [&] {
                std::ostringstream text;
                text << stream.rdbuf();
                osg::ref_ptr<osgTSS::Scene> scene = new osgTSS::Scene;
                scene->setText(text.str());
                return scene;
            },
            options, "scene");
    }

    WriteResult writeObject(const osg::Object& object, const std::string& file,
                            const Options* options) const override {
        const osg::Node* node = object.asNode();
        return node ? writeNode(*node, file, options) : WriteResult(WriteResult::FILE_NOT_HANDLED);
    }

    WriteResult writeNode(const osg::Node& node, const std::string& file, const Options*) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return WriteResult::FILE_NOT_HANDLED;
        try {
            // Visitors take nodes that may change; these do not change them.
            osgTSS::writeScene(const_cast<osg::Node&>(node), file);
            return WriteResult::FILE_SAVED;
        } catch (const std::exception& error) {
            OSG_WARN << "osgTSS: " << error.what() << std::endl;
            return WriteResult(error.what());
        }
    }

private:
    /// FILE.EXT.tss, where there is only FILE.EXT: extracted and baked by the plugin that links the baker.
    static ReadResult readBaked(const std::string& file, const Options* options) {
        const std::string source = osgDB::getNameLessExtension(file);
        if (osgDB::getFileExtension(source).empty() || osgDB::findDataFile(source, options).empty())
            return ReadResult::FILE_NOT_FOUND;
        osgDB::ReaderWriter* baker = osgDB::Registry::instance()->getReaderWriterForExtension("tssbake");
        if (!baker)
            return ReadResult(file + ": there is no such file, and baking " + source +
                              " takes the plugin osgdb_tssbake, which was not found");
        return baker->readNode(source + ".tssbake", options);
    }

    template <class Read>
    ReadResult guarded(const Read& read, const Options* options, const std::string& name) const {
        try {
            const osgTSS::LoadOptions load(options ? options->getOptionString() : std::string());
            osg::ref_ptr<osgTSS::Scene> scene = read();
            scene->setName(osgDB::getSimpleFileName(name));
            osg::ref_ptr<osg::Node> root = osgTSS::createPlayingGraph(*scene, load);
            return ReadResult(root);
        } catch (const std::exception& error) {
            OSG_WARN << "osgTSS: " << error.what() << std::endl;
            return ReadResult(error.what());
        }
    }
};

REGISTER_OSGPLUGIN(tss, ReaderWriterTSS)

} // namespace
