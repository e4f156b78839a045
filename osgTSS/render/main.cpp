// tss-render: pictures of a scene where there is no X server. Exit 0 done, 1 the input is at fault, 2 usage,
// 3 internal.
#include "EglContext.h"
#include "FramePattern.h"
#include "OffscreenViewer.h"

#include "bake/base/Error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgTSS/Scene>
#include <osgTSS/SceneFile>
#include <osgTSS/Version>
#include <osgTSS/ViewerCallback>

#include <cmath>
#include <fstream>
#include <unistd.h>
#include <vector>

namespace {

struct Arguments {
    std::string scene, output, view, options;
    std::string size = "800x600";
    int frames = 0; ///< 0: one round of the motion
    int every = 1;
    int finer = 2;
    bool overlay = false, json = false, quiet = false;
};

osgTSS::Shot shotOf(const Arguments& arguments) {
    osgTSS::Shot shot;
    char x = 0, rest = 0;
    constexpr int most = 4096;
    if (std::sscanf(arguments.size.c_str(), "%d%c%d%c", &shot.width, &x, &shot.height, &rest) != 3 ||
        x != 'x' || shot.width < 1 || shot.height < 1 || shot.width > most || shot.height > most)
        throw CLI::ValidationError("--size", "expected WxH in pixels, found " + arguments.size);
    shot.finer = arguments.finer;
    if (arguments.view.empty()) return shot;
    std::ifstream file(arguments.view);
    std::vector<double> numbers;
    for (double number = 0; file >> number;) numbers.push_back(number);
    // The path's own reader would wait forever for the end of what is no number.
    if (numbers.empty() || numbers.size() % 8 != 0 || !file.eof())
        throw tss::InputError({arguments.view, "", ""}, "expected a camera path as osgviewer -p reads it");
    shot.view = new osg::AnimationPath;
    for (std::size_t k = 0; k < numbers.size(); k += 8) {
        const double* n = &numbers[k]; // time, x, y, z, and the rotation
        shot.view->insert(n[0], {{n[1], n[2], n[3]}, {n[4], n[5], n[6], n[7]}});
    }
    return shot;
}

osg::ref_ptr<osg::Node> load(const Arguments& arguments) {
    const std::string words =
        "clock=frame " + std::string(arguments.overlay ? "overlay " : "") + arguments.options;
    if (arguments.scene.ends_with(".tss") && osgDB::fileExists(arguments.scene)) {
        const osgTSS::LoadOptions options(words);
        osg::ref_ptr<osgTSS::Scene> scene = osgTSS::readScene(arguments.scene);
        return osgTSS::createPlayingGraph(*scene, options);
    }
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(words);
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(arguments.scene, options.get());
    if (!node) throw tss::InputError({arguments.scene, "", ""}, "no scene that can be read");
    if (arguments.overlay) {
        osgTSS::Scene* scene = osgTSS::Scene::on(*node);
        if (!scene || !node->asGroup())
            throw tss::InputError({arguments.scene, "", ""},
                                  "has no tables of osgTSS that --overlay could show");
        osgTSS::addViewerAids(*node->asGroup(), *scene, true);
    }
    return node;
}

unsigned int framesOf(const Arguments& arguments, const osg::Node& scene) {
    if (arguments.frames > 0) return static_cast<unsigned int>(arguments.frames);
    const osgTSS::Scene* found = osgTSS::Scene::on(scene);
    const double codes = found ? found->getClock().end - found->getClock().start : 0;
    return static_cast<unsigned int>(std::max(0.0, std::floor(codes))) + 1;
}

void write(const osg::Image& image, const std::string& name) {
    // Beside, then renamed: never a part of a picture.
    const std::size_t dot = name.rfind('.');
    const std::string beside =
        name.substr(0, dot) + ".part" + (dot == std::string::npos ? "" : name.substr(dot));
    if (!osgDB::writeImageFile(image, beside) || std::rename(beside.c_str(), name.c_str()) != 0)
        throw tss::InputError({name, "", ""}, "cannot be written; expected a folder that is there and a "
                                              "picture format that OpenSceneGraph writes, such as .png");
}

int render(const Arguments& arguments) {
    const osgTSS::Shot shot = shotOf(arguments);
    const bool pattern = osgTSS::isFramePattern(arguments.output);
    if (!pattern && (arguments.frames != 1 || arguments.output.find('%') != std::string::npos))
        throw CLI::ValidationError(
            "--output", "expected one %d for the frame number, as in f_%04d.png, found " + arguments.output);
    const osg::ref_ptr<osg::Node> scene = load(arguments);
    const unsigned int frames = framesOf(arguments, *scene);

    const osgTSS::EglContext context;
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    {
        osgTSS::OffscreenViewer viewer(*scene, shot);
        for (unsigned int frame = 0; frame < frames; ++frame) {
            if (frame % static_cast<unsigned int>(arguments.every) != 0) {
                viewer.pass(frame);
                continue;
            }
            const osg::Image& image = viewer.draw(frame);
            const std::string name = pattern ? osgTSS::frameName(arguments.output, frame) : arguments.output;
            write(image, name);
            files.push_back(name);
            if (!arguments.quiet && isatty(STDERR_FILENO))
                fmt::print(stderr, "\rframe {} of {}{}", frame + 1, frames, frame + 1 == frames ? "\n" : "");
        }
    }
    if (!arguments.quiet)
        fmt::print(arguments.json ? stderr : stdout, "{} picture{}, {} to {}\n", files.size(),
                   files.size() == 1 ? "" : "s", files.front().get<std::string>(),
                   files.back().get<std::string>());
    if (arguments.json)
        fmt::print("{}\n", nlohmann::ordered_json{{"frames", frames}, {"files", files}}.dump());
    return 0;
}

int fail(const Arguments& arguments, int code, const std::string& message) {
    fmt::print(stderr, "tss-render: {}\n", message);
    if (arguments.json)
        fmt::print("{}\n", nlohmann::ordered_json{{"error", {{"message", message}}}, {"exit", code}}.dump());
    return code;
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app{"Pictures of a scene, one time code a frame, without an X server (EGL).", "tss-render"};
    app.set_version_flag("--version", std::string("tss-render ") + osgTSSGetVersion());
    app.add_option("scene", arguments.scene, "a .tss scene, or any file that OpenSceneGraph reads")
        ->required();
    app.add_option("-o,--output", arguments.output, "where pictures go, with %04d for the frame number")
        ->required();
    app.add_option("--frames", arguments.frames, "how many (default: one round of the motion)")
        ->check(CLI::PositiveNumber);
    app.add_option("--every", arguments.every, "write only every N-th frame")->check(CLI::PositiveNumber);
    app.add_option("--size", arguments.size, "WxH in pixels")->capture_default_str();
    app.add_option("--finer", arguments.finer, "pixels drawn along each side of one, and averaged")
        ->check(CLI::Range(1, 4))
        ->capture_default_str();
    app.add_option("--view", arguments.view, "camera path, as osgviewer -p reads it (default: all in sight)");
    app.add_flag("--overlay", arguments.overlay, "show spheres, tested pairs and contacts");
    app.add_option("--options", arguments.options,
                   "further words for the loader, as osgviewer -O takes them");
    app.add_flag("--json", arguments.json, "one JSON object on stdout, everything else on stderr");
    app.add_flag("--quiet", arguments.quiet, "nothing but errors and what was asked for");
    app.footer("Example: tss-render dog_jaw_baked.tss -o jaw_%04d.png --frames 97 --every 8 --overlay\n"
               "Exit: 0 done, 1 the input is at fault, 2 usage, 3 internal error.");
    try {
        app.parse(argc, argv);
        return render(arguments);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const tss::InputError& error) {
        return fail(arguments, 1, error.what());
    } catch (const std::exception& error) {
        return fail(arguments, 3, std::string("internal error: ") + error.what());
    }
}
