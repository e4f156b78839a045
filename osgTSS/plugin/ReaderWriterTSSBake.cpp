#include "bake/Bake.h"
#include "bake/base/Error.h"
#include "bake/scene/ReadScene.h"
#include "bake/scene/ToLayer.h"

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/LoadOptions>
#include <osgTSS/ViewerCallback>

#include <exception>

namespace {

/// FILE.EXT.tssbake (asked for as FILE.EXT.tss): reads FILE.EXT with its own plugin, finds the joints in it,
/// bakes their pairs and installs the tables on the very graph, which keeps its looks. Options beside those
/// of .tss: the settings of a bake, and pairs=neighbours|siblings|all|tagged.
class ReaderWriterTSSBake : public osgDB::ReaderWriter {
public:
    ReaderWriterTSSBake() {
        supportsExtension("tssbake", "Pseudo-loader that bakes any graph with joints");
        supportsOption("pairs=<neighbours|siblings|all|tagged>", "Which bodies are baked against each other");
        supportsOption("<setting>=<value>", "Settings of 'tss bake' without dashes, such as tolerance=0.1");
    }

    const char* className() const override { return "Tabulated sphere subset baking pseudo-loader"; }

    ReadResult readNode(const std::string& file, const Options* options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file))) return ReadResult::FILE_NOT_HANDLED;
        const std::string source = osgDB::getNameLessExtension(file);
        osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(source, options);
        if (!root) return ReadResult(source + ": no plugin reads it");
        try {
            const osgTSS::LoadOptions load(options ? options->getOptionString() : std::string());
            bake(*root, load, source);
            return ReadResult(root);
        } catch (const std::exception& error) {
            OSG_WARN << "osgTSS: " << source << ": " << error.what() << std::endl;
            return ReadResult(source + ": " + error.what());
        }
    }

private:
    static void bake(osg::Node& root, const osgTSS::LoadOptions& load, const std::string& source) {
        osgTSS::ConstraintVisitor visitor(pairsOf(load));
        root.accept(visitor);
        // Through the layer, which rounds to what a file stores: the tables then fit the file this is saved
        // as.
        auto model =
            std::make_shared<tss::SceneModel>(tss::readScene(tss::toLayer(visitor.getModel()), source));
        if (model->pairs.empty())
            OSG_NOTICE << "osgTSS: " << source << " has no joints between bodies; nothing was baked"
                       << std::endl;
        const tss::BakeSettings settings = settingsOf(load);
        tss::optionsFor({}, settings, model->metersPerUnit); // a wrong word is no pair's fault
        for (const tss::Pair& pair : model->pairs) bakeOne(*model, pair.path, settings);
        osg::ref_ptr<osgTSS::Scene> scene = new osgTSS::Scene(model, load.clock);
        scene->setName(osgDB::getSimpleFileName(source));
        osgTSS::install(root, *scene);
        if (osg::Group* group = root.asGroup()) osgTSS::addViewerAids(*group, *scene, load.overlay);
    }

    /// A pair that cannot be baked is shown as it moves, and the others are kept apart all the same.
    static void bakeOne(tss::SceneModel& model, const std::string& path, const tss::BakeSettings& settings) {
        tss::BakeRequest request;
        request.given = settings;
        request.pairs = {path};
        try {
            for (const tss::PairReport& report : tss::bake(model, request)) {
                const tss::Pair& pair = model.pairs[static_cast<std::size_t>(tss::findPair(model, path))];
                OSG_NOTICE << "osgTSS: baked " << path << " in " << report.seconds << " s: "
                           << (pair.table ? std::to_string(pair.table->testCount()) + " tests"
                                          : "never collides")
                           << std::endl;
                for (const std::string& note : report.notes) OSG_NOTICE << "osgTSS:   " << note << std::endl;
            }
        } catch (const tss::InputError& error) {
            OSG_WARN << "osgTSS: " << path << " is not kept apart: " << error.what() << std::endl;
        }
    }

    static osgTSS::ConstraintVisitor::Pairs pairsOf(const osgTSS::LoadOptions& load) {
        const auto found = load.others.find("pairs");
        const std::string name = found == load.others.end() ? "neighbours" : found->second;
        if (name == "neighbours") return osgTSS::ConstraintVisitor::NEIGHBOURS;
        if (name == "siblings") return osgTSS::ConstraintVisitor::SIBLINGS;
        if (name == "all") return osgTSS::ConstraintVisitor::ALL;
        if (name == "tagged") return osgTSS::ConstraintVisitor::TAGGED;
        throw tss::InputError("option pairs: expected neighbours, siblings, all or tagged, found \"" + name +
                              "\"");
    }

    /// Other plugins have words of their own in the same option string, so that a word that is none of ours
    /// is only remarked upon.
    static tss::BakeSettings settingsOf(const osgTSS::LoadOptions& load) {
        tss::BakeSettings given;
        for (const auto& [key, value] : load.others)
            if (tss::isOption(key))
                given[key] = value;
            else if (key != "pairs")
                OSG_NOTICE << "osgTSS: option \"" << key << "\" is none of tss bake's" << std::endl;
        return given;
    }
};

REGISTER_OSGPLUGIN(tssbake, ReaderWriterTSSBake)

} // namespace
