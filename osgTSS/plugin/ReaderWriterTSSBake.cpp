#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>
#include <osgTSS/Bake>
#include <osgTSS/Install>
#include <osgTSS/LoadOptions>
#include <osgTSS/PlayAnimations>
#include <osgTSS/ViewerCallback>

#include <chrono>
#include <exception>

namespace {

/// Says what is being done to who waits for the picture, now and then, and once how it would go quicker.
class Outlook {
public:
    explicit Outlook(const osgTSS::BakeOptions& options) : _kept(options.cache != "off") {}

    bool operator()(const std::string& what, double done) {
        constexpr auto every = std::chrono::seconds(5);
        const Time::time_point now = Time::now();
        if (now - _said < every) return true;
        if (_said == _start)
            OSG_NOTICE << "osgTSS: a coarser tolerance= and a shorter budget= in -O are quicker"
                       << (_kept ? "; what is baked by then is kept for the next load" : "") << std::endl;
        _said = now;
        OSG_NOTICE << "osgTSS: baked " << int(100 * done) << " % after "
                   << std::chrono::duration_cast<std::chrono::seconds>(now - _start).count() << " s, now "
                   << what << std::endl;
        return true;
    }

private:
    using Time = std::chrono::steady_clock;
    const bool _kept;
    const Time::time_point _start = Time::now();
    Time::time_point _said = _start;
};

/// FILE.EXT.tssbake (asked for as FILE.EXT.tss): reads FILE.EXT with its own plugin, finds the joints in it,
/// bakes their pairs and installs the tables on the very graph, which keeps its looks. Options beside those
/// of .tss: osgTSS::BakeOptions.
class ReaderWriterTSSBake : public osgDB::ReaderWriter {
public:
    ReaderWriterTSSBake() {
        supportsExtension("tssbake", "Pseudo-loader that bakes any graph with joints");
        supportsOption("pairs=<neighbours|siblings|all|tagged>", "Which bodies are baked against each other");
        supportsOption("switches=<all|active>", "Of switches what they can show (default), or show now");
        supportsOption("limits=<NAME:rotZ:-24:18,...>",
                       "Limits of DOFTransforms (* for all names), degrees and units of length");
        supportsOption("static=<NAME,...>", "Transforms that are taken to stand still");
        supportsOption("ignore=<NAME,...>", "Nodes that are drawn, but part of no body");
        supportsOption("still=<DEGREES>", "Turns of bones of less than this are no degree of freedom");
        supportsOption(
            "play", "Play the animations that nothing plays, one after the other, and swing DOFTransforms");
        supportsOption("cache=<FILE|off>",
                       "Where tables are kept (default FILE.EXT.cache.tss beside the file)");
        supportsOption("<setting>=<value>", "Settings of 'tss bake' without dashes, such as tolerance=0.1");
    }

    const char* className() const override { return "Tabulated sphere subset baking pseudo-loader"; }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        const std::string source = osgDB::getNameLessExtension(file);
        osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(source, options);
        if (!root)
            return ReadResult(source +
                              ": no plugin of OpenSceneGraph reads it; of a robot or of meshes 'tss make' "
                              "makes a scene that is shown");
        try {
            const osgTSS::LoadOptions load(options ? options->getOptionString() : std::string());
            bake(*root, load, source);
            if (load.play) osgTSS::playAnimations(*root);
            return ReadResult(root);
        } catch (const std::exception& error) {
            OSG_WARN << "osgTSS: " << source << ": " << error.what() << std::endl;
            return ReadResult(source + ": " + error.what());
        }
    }

private:
    /// Those that mean something, or are other plugins': what does not is told, and the file is shown all the
    /// same.
    static std::map<std::string, std::string> usable(std::map<std::string, std::string> words) {
        std::erase_if(words, [](const auto& word) {
            try {
                osgTSS::BakeOptions(std::map<std::string, std::string>{word});
                return false;
            } catch (const std::exception& error) {
                OSG_WARN << "osgTSS: " << error.what() << "; it is passed over" << std::endl;
                return true;
            }
        });
        return words;
    }

    static void bake(osg::Node& root, const osgTSS::LoadOptions& load, const std::string& source) {
        osgTSS::BakeOptions given(usable(load.others));
        given.firstLook = true;
        // Beside the file, as it is found: baked once, and again where it has changed.
        if (given.cache.empty()) given.cache = osgDB::findDataFile(source) + ".cache.tss";
        osg::ref_ptr<osgTSS::Scene> scene = osgTSS::bake(root, given, Outlook(given));
        scene->setClock(osgTSS::Clock(scene->getModel(), load.clock));
        scene->setName(osgDB::getSimpleFileName(source));
        osgTSS::install(root, *scene);
        if (osg::Group* group = root.asGroup()) osgTSS::addViewerAids(*group, *scene, load.overlay);
    }
};

REGISTER_OSGPLUGIN(tssbake, ReaderWriterTSSBake)

} // namespace
