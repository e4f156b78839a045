// tss-render: pictures of a scene where there is no X server. Exit 0 done, 1 the input is at fault, 2 usage,
// 3 internal.
#include "EglContext.h"
#include "OffscreenViewer.h"
#include "Reach.h"

#include "bake/base/Error.h"
#include "bake/base/FramePattern.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgTSS/LoadOptions>
#include <osgTSS/PlayAnimations>
#include <osgTSS/Scene>
#include <osgTSS/SceneFile>
#include <osgTSS/Version>
#include <osgTSS/ViewerCallback>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <unistd.h>
#include <vector>

namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
    std::string scene, output, view, options;
    std::string size = "800x600";
    int frames = 0; ///< 0: one round of the motion
    int every = 1;
    int finer = 2;
    bool overlay = false;
    bool rest = false;
    bool json = false, quiet = false;
};

/// Which pictures were written, of how many frames; at least one.
void tellPictures(const Arguments& arguments, unsigned int frames, const std::vector<std::string>& files) {
    if (!arguments.quiet)
        fmt::print(arguments.json ? stderr : stdout, "{} picture{}, {} to {}\n", files.size(),
                   files.size() == 1 ? "" : "s", files.front(), files.back());
    if (arguments.json) fmt::print("{}\n", Json{{"frames", frames}, {"files", files}}.dump());
}

/// Returns the code to exit with, as it is given.
int tellFailure(const Arguments& arguments, int code, const std::string& message) {
    fmt::print(stderr, "tss-render: {}\n", message);
    if (arguments.json) fmt::print("{}\n", Json{{"error", {{"message", message}}}, {"exit", code}}.dump());
    return code;
}

/// "x,y,z:x,y,z": the eye, and what it looks at.
std::optional<std::array<osg::Vec3d, 2>> placeOf(const std::string& text) {
    std::array<osg::Vec3d, 2> place;
    auto& [eye, at] = place;
    int end = 0;
    const int found = std::sscanf(text.c_str(), "%lf,%lf,%lf:%lf,%lf,%lf%n", &eye[0], &eye[1], &eye[2],
                                  &at[0], &at[1], &at[2], &end);
    if (found != 6 || static_cast<std::size_t>(end) != text.size() || !eye.valid() || !at.valid() ||
        eye == at)
        return std::nullopt;
    return place;
}

osgTSS::Shot shotOf(const Arguments& arguments) {
    osgTSS::Shot shot;
    char x = 0, rest = 0;
    constexpr int most = 4096;
    if (std::sscanf(arguments.size.c_str(), "%d%c%d%c", &shot.width, &x, &shot.height, &rest) != 3 ||
        x != 'x' || shot.width < 1 || shot.height < 1 || shot.width > most || shot.height > most)
        throw CLI::ValidationError(
            "--size", fmt::format("expected WxH in pixels, each 1 to {}, found {}", most, arguments.size));
    shot.finer = arguments.finer;
    shot.framing = osgTSS::Framing(static_cast<double>(shot.width) / shot.height);
    if (arguments.view.empty()) return shot;
    if (const auto place = placeOf(arguments.view)) {
        shot.place = place;
        return shot;
    }
    std::ifstream file(arguments.view);
    std::vector<double> numbers;
    for (double number = 0; file >> number;) numbers.push_back(number);
    // The path's own reader would wait forever for the end of what is no number.
    if (numbers.empty() || numbers.size() % 8 != 0 || !file.eof())
        throw tss::InputError(
            {arguments.view, "", ""},
            "expected a camera path as osgviewer -p reads it, or two places EYE:AT, as in 0,-3,1:0,0,1");
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

/// Whether the loader turns the scene, so that its Y axis stands up.
bool isTurned(const Arguments& arguments, const osg::Node& graph) {
    const osgTSS::Scene* scene = osgTSS::Scene::on(graph);
    return scene && scene->getModel().upAxis == 'Y' && osgTSS::LoadOptions(arguments.options).graph.rotateUp;
}

/// `seconds`: of its animations.
unsigned int framesOf(const Arguments& arguments, const osg::Node& scene, double seconds) {
    if (arguments.frames > 0) return static_cast<unsigned int>(arguments.frames);
    const osgTSS::Scene* found = osgTSS::Scene::on(scene);
    const double codes = std::max(found ? found->getClock().end - found->getClock().start : 0,
                                  std::ceil(seconds * osgTSS::framesPerSecond));
    return static_cast<unsigned int>(std::max(0.0, std::floor(codes))) + 1;
}

/// Lets the last time code be shown before the motion begins again, where it does not end as it began.
void showEnd(osgTSS::Scene& scene) {
    osgTSS::Clock clock = scene.getClock();
    const auto differs = [&](const tss::TimeSamples& samples) {
        return samples.at(clock.start) != samples.at(clock.end);
    };
    const tss::SceneModel& model = scene.getModel();
    const bool open = std::ranges::any_of(model.joints,
                                          [&](const tss::Joint& joint) {
                                              return std::ranges::any_of(joint.drives, differs);
                                          }) ||
                      std::ranges::any_of(model.muscles, [&](const tss::MuscleModel& muscle) {
                          return differs(muscle.activation);
                      });
    if (!open) return;
    clock.end += 1;
    scene.setClock(clock);
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

void render(const Arguments& arguments) {
    osgTSS::Shot shot = shotOf(arguments);
    const bool pattern = tss::isFramePattern(arguments.output);
    if (!pattern && (arguments.frames != 1 || arguments.output.find('%') != std::string::npos))
        throw CLI::ValidationError(
            "--output", "expected one %d for the frame number, as in f_%04d.png, found " + arguments.output);
    const osg::ref_ptr<osg::Node> scene = load(arguments);
    const double seconds = arguments.rest ? 0 : osgTSS::playAnimations(*scene);
    const unsigned int frames = framesOf(arguments, *scene, seconds);
    if (osgTSS::Scene* found = osgTSS::Scene::on(*scene)) {
        shot.framed = osgTSS::hasScenery(found->getModel());
        if (!shot.place && !shot.view && (frames > 1 || shot.framed))
            osgTSS::addReach(shot.framing, found->getModel(), isTurned(arguments, *scene), seconds > 0,
                             frames == 1);
        if (frames > 1) showEnd(*found);
    }
    if (shot.place)
        for (osg::Vec3d& point : *shot.place) point = osgTSS::shown(point, isTurned(arguments, *scene));

    const osgTSS::EglContext context;
    std::vector<std::string> files;
    {
        osgTSS::OffscreenViewer viewer(*scene, shot);
        for (unsigned int frame = 0; frame < frames; ++frame) {
            if (frame % static_cast<unsigned int>(arguments.every) != 0) {
                viewer.pass(frame);
                continue;
            }
            const osg::Image& image = viewer.draw(frame);
            const std::string name = pattern ? tss::frameName(arguments.output, frame) : arguments.output;
            write(image, name);
            files.push_back(name);
            if (!arguments.quiet && isatty(STDERR_FILENO))
                fmt::print(stderr, "\rframe {} of {}{}", frame + 1, frames, frame + 1 == frames ? "\n" : "");
        }
    }
    tellPictures(arguments, frames, files);
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App options("Pictures of a scene, one time code a frame, without an X server (EGL).", "tss-render");
    options.set_version_flag("--version", std::string("tss-render ") + osgTSSGetVersion());
    // CLI::PositiveNumber would name the largest double as what may be.
    const CLI::Validator positive(
        [](const std::string& text) {
            return std::strtod(text.c_str(), nullptr) > 0 ? std::string()
                                                          : "expected more than 0, found " + text;
        },
        "POSITIVE");
    options.add_option("scene", arguments.scene, "a .tss scene, or any file that OpenSceneGraph reads")
        ->required();
    options.add_option("-o,--output", arguments.output, "where pictures go, with %04d for the frame number")
        ->required();
    options.add_option("--frames", arguments.frames, "how many (default: one round of the motion)")
        ->check(positive);
    options.add_option("--every", arguments.every, "write only every N-th frame")->check(positive);
    options.add_option("--size", arguments.size, "WxH in pixels")->capture_default_str();
    options.add_option("--finer", arguments.finer, "pixels drawn along each side of one, and averaged")
        ->check(CLI::Range(1, 4))
        ->capture_default_str();
    options.add_option("--view", arguments.view,
                       "a camera path, as osgviewer -p reads it, or EYE:AT in scene units, such as "
                       "0,-3,1:0,0,1 (default: from the front, right and above, all of the motion in sight, "
                       "but not of a ground that dwarfs it)");
    options.add_flag("--rest", arguments.rest, "animations that nothing plays are not played either");
    options.add_flag("--overlay", arguments.overlay, "show spheres, tested pairs and contacts");
    options.add_option("-O,--options", arguments.options,
                       "further words for the loader, as osgviewer -O takes them");
    options.add_flag("--json", arguments.json, "one JSON object on stdout, everything else on stderr");
    options.add_flag("--quiet", arguments.quiet, "nothing but errors and what was asked for");
    options.footer("Example: tss-render dog_jaw_baked.tss -o jaw_%04d.png --frames 97 --every 8 --overlay\n"
                   "Exit: 0 done, 1 the input is at fault, 2 usage, 3 internal error.");
    options.callback([&] { render(arguments); });
    try {
        options.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        return options.exit(error) == 0 ? 0 : 2;
    } catch (const tss::InputError& error) {
        return tellFailure(arguments, 1, error.what());
    } catch (const std::exception& error) {
        return tellFailure(arguments, 3, std::string("internal error: ") + error.what());
    }
}
