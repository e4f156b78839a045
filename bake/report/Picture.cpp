#include "bake/report/Drawing.h"

#include "bake/motion/DofUnits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <png.h>
#include <stdexcept>

namespace tss::reporting {

namespace {

constexpr int width = 360, height = 270, shades = 60;
constexpr std::array<std::array<double, 3>, 2> bodyColours{{{224, 178, 92}, {92, 148, 214}}}; // of A and of B

/// Where to look from, and how large things are drawn.
struct View {
    Eigen::Matrix3d axes; ///< rows: right, up, towards the eye
    Vec3 middle = Vec3::Zero();
    double pixels = 1; ///< a scene unit
};

/// A in the world, and B where the joint has these values.
std::array<Pose, 2> posesAt(const SceneModel& scene, const Pair& pair, const Motion& motion,
                            const std::vector<double>& values) {
    const Pose& a = scene.bodies[pair.bodyA].placement;
    return {a, Pose(a * pose(motion, values))};
}

Eigen::Matrix3d axesTowards(const Vec3& eye, const Vec3& up) {
    const Vec3 right =
        (std::abs(eye.dot(up)) < 0.99 ? up : Vec3(up.y(), up.z(), up.x())).cross(eye).normalized();
    Eigen::Matrix3d axes;
    axes << right.transpose(), eye.cross(right).transpose(), eye.transpose();
    return axes;
}

View viewOf(const SceneModel& scene, const Pair& pair, const Motion& motion, std::size_t leadingDof,
            const std::vector<std::vector<double>>& poses) {
    const Vec3 up = scene.upAxis == 'Y' ? Vec3::UnitY() : Vec3::UnitZ();
    Vec3 eye = scene.upAxis == 'Y' ? Vec3::UnitZ() : Vec3(-Vec3::UnitY());
    if (motion.dofs.size() > leadingDof && motion.dofs[leadingDof].kind == DofKind::Rotation) {
        const Dof& dof = motion.dofs[leadingDof];
        const Pose& a = scene.bodies[pair.bodyA].placement;
        const Vec3 axis = (a.linear() * motion.base.linear() * dof.frame.linear() * dof.axis).normalized();
        if (axis.allFinite()) eye = axis.dot(eye) < 0 ? Vec3(-axis) : axis;
    }
    View view;
    // A little from above and beside, so that shapes are read.
    view.axes = axesTowards((eye + 0.25 * up + 0.2 * up.cross(eye)).normalized(), up);
    Eigen::AlignedBox3d box;
    for (const auto& values : poses) {
        const auto placed = posesAt(scene, pair, motion, values);
        for (const int k : {0, 1})
            for (const Vec3& v : scene.bodies[k ? pair.bodyB : pair.bodyA].mesh.vertices)
                box.extend(view.axes * (placed[k] * v));
    }
    if (box.isEmpty()) return view;
    view.middle = box.center();
    const Vec3 size = box.sizes();
    view.pixels = 0.94 * std::min(width / std::max(size.x(), 1e-300), height / std::max(size.y(), 1e-300));
    return view;
}

class Canvas {
public:
    explicit Canvas(const View& view) : view_(view) {}

    void draw(const TriangleMesh& mesh, const Pose& pose, int body) {
        for (const Tri& t : mesh.triangles) {
            std::array<Vec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 x = view_.axes * (pose * mesh.vertices[t[int(k)]]) - view_.middle;
                corner[k] = {width / 2.0 + view_.pixels * x.x(), height / 2.0 - view_.pixels * x.y(),
                             view_.pixels * x.z()};
            }
            fill(corner, body);
        }
    }

    /// The bytes of a PNG file; what is not covered is transparent.
    std::string png() const {
        std::vector<std::uint8_t> colours{0, 0, 0, 0};
        for (const auto& colour : bodyColours)
            for (int shade = 0; shade < shades; ++shade) {
                for (const double channel : colour)
                    colours.push_back(
                        static_cast<std::uint8_t>(channel * (0.25 + 0.75 * shade / (shades - 1.0))));
                colours.push_back(255);
            }
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        image.width = width;
        image.height = height;
        image.format = PNG_FORMAT_RGBA_COLORMAP;
        image.colormap_entries = static_cast<png_uint_32>(colours.size() / 4);
        png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
        std::string out(size, '\0');
        if (png_image_write_to_memory(&image, out.data(), &size, 0, pixels_.data(), 0, colours.data()) == 0)
            throw std::logic_error(std::string("a picture cannot be written: ") + image.message);
        out.resize(size);
        return out;
    }

private:
    void fill(const std::array<Vec3, 3>& p, int body) {
        const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
        const double area = normal.z(), length = normal.norm();
        if (!(std::abs(area) > 1e-12) || !std::isfinite(length)) return;
        const double light = std::abs(area) / length; // either side
        const auto shade = static_cast<std::uint8_t>(1 + body * shades + std::lround(light * (shades - 1)));
        const auto range = [&](int axis, int end) {
            const auto [least, most] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
            return std::pair{std::clamp(int(std::ceil(least - 0.5)), 0, end),
                             std::clamp(int(std::floor(most - 0.5)) + 1, 0, end)};
        };
        const auto [left, right] = range(0, width);
        const auto [top, bottom] = range(1, height);
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const Vec3 at(x + 0.5, y + 0.5, 0);
                std::array<double, 3> weight{};
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3 &u = p[(k + 1) % 3], &v = p[(k + 2) % 3];
                    weight[k] =
                        ((u.x() - at.x()) * (v.y() - at.y()) - (u.y() - at.y()) * (v.x() - at.x())) / area;
                }
                if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) continue;
                const double depth = weight[0] * p[0].z() + weight[1] * p[1].z() + weight[2] * p[2].z();
                const std::size_t pixel = std::size_t(y) * width + std::size_t(x);
                if (depth <= depths_[pixel]) continue;
                depths_[pixel] = depth;
                pixels_[pixel] = shade;
            }
    }

    const View& view_;
    std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(std::size_t(width) * height, 0);
    std::vector<double> depths_ =
        std::vector<double>(std::size_t(width) * height, -std::numeric_limits<double>::infinity());
};

} // namespace

std::vector<Picture> picturesOf(const SceneModel& scene, const Pair& pair, std::size_t leadingDof) {
    const Motion motion = pairMotion(scene, pair);
    std::vector<std::vector<double>> poses{restValues(motion)};
    std::vector<std::string> captions{"at rest"};
    if (leadingDof < motion.dofs.size()) {
        const Dof& dof = motion.dofs[leadingDof];
        for (const double limit : {dof.lower, dof.upper}) {
            if (limit == dof.rest) continue;
            poses.push_back(poses.front());
            poses.back()[leadingDof] = limit;
            captions.push_back(fmt::format("{} {:.4g}{}", dof.name, toUser(dof, limit),
                                           dof.kind == DofKind::Rotation ? "°" : ""));
        }
    }
    const View view = viewOf(scene, pair, motion, leadingDof, poses);
    std::vector<Picture> pictures;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const auto placed = posesAt(scene, pair, motion, poses[k]);
        Canvas canvas(view);
        canvas.draw(scene.bodies[pair.bodyA].mesh, placed[0], 0);
        canvas.draw(scene.bodies[pair.bodyB].mesh, placed[1], 1);
        pictures.push_back({captions[k], canvas.png()});
    }
    return pictures;
}

} // namespace tss::reporting
