#include "bake/tool/WriteSpheres.h"

#include "bake/base/Error.h"
#include "bake/robot/PairEvidence.h"
#include "bake/spheres/GenerateSpheres.h"

#include <cmath>
#include <fmt/format.h>

namespace tss::tool {

namespace {

/// A name as a YAML key, whatever is in it.
std::string quoted(const std::string& name) {
    std::string text = "\"";
    for (char c : name) {
        if (c == '"' || c == '\\') text += '\\';
        text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return text + "\"";
}

} // namespace

SpheresWritten curoboSpheresOf(const SceneModel& scene, const SphereOptions& options) {
    SpheresWritten written;
    written.text = "# Spheres of each link, in its frame and in metres. They hold the whole surface of its "
                   "mesh, proven.\n"
                   "collision_spheres:\n";
    const double metre = scene.metersPerUnit;
    constexpr double rounding = 1e-12; // of a product and of the digits written
    for (const Body& body : scene.bodies) {
        if (!body.rigid || body.mesh.empty()) continue;
        const std::string name = originalName(body);
        const SphereFit fit = fitSpheres(body.mesh, options);
        if (!std::isfinite(fit.protrusion) || fit.coverage > 0)
            throw InputError(Where{"", "", body.path}, "its mesh cannot be covered by spheres with a bound");
        if (!fit.note.empty()) written.notes.push_back(name + ": " + fit.note);
        written.text += fmt::format("  {}: # {} spheres, out of the link by at most {:.4g} mm{}\n",
                                    quoted(name), fit.spheres.size(), 1000 * metre * fit.protrusion,
                                    fit.hollow ? "; taken for its surface alone" : "");
        for (const Sphere& sphere : fit.spheres) {
            const Vec3 centre = metre * sphere.centre;
            const double radius = metre * sphere.radius, slack = rounding * (radius + centre.norm());
            written.text += fmt::format("    - \"center\": [{}, {}, {}]\n      \"radius\": {}\n", centre.x(),
                                        centre.y(), centre.z(), radius + slack);
        }
        ++written.links;
        written.spheres += fit.spheres.size();
    }
    if (written.links == 0) throw InputError("expected a rigid body with a mesh, found none");
    return written;
}

} // namespace tss::tool
