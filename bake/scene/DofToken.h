#pragma once
#include "bake/motion/Motion.h"

#include <array>
#include <string>

namespace tss {

/// The degrees of freedom of a PhysicsJoint, in the order that holds when tss:dofOrder is absent.
inline constexpr std::array<const char*, 6> dofTokens = {"transX", "transY", "transZ",
                                                         "rotX",   "rotY",   "rotZ"};

/// A degree of freedom by its token: rotX, transZ, path0, ... Nothing is known of limits yet. False for a
/// word that is no token.
inline bool dofFromToken(const std::string& token, Dof& dof, std::size_t& path) {
    for (std::size_t k = 0; k < dofTokens.size(); ++k)
        if (token == dofTokens[k]) {
            dof.kind = k < 3 ? DofKind::Translation : DofKind::Rotation;
            dof.axis = Vec3::Unit(static_cast<int>(k % 3));
            return true;
        }
    if (token.size() < 5 || token.size() > 9 || !token.starts_with("path")) return false;
    for (char c : token.substr(4))
        if (c < '0' || c > '9') return false;
    dof.kind = DofKind::Path;
    path = std::stoul(token.substr(4));
    return "path" + std::to_string(path) == token;
}

} // namespace tss
