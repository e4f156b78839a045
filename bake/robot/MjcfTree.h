#pragma once
#include "bake/motion/Motion.h"
#include "bake/robot/ReadRobot.h"
#include "bake/robot/Xml.h"

#include <list>

namespace tss {

/// What the compiler element says, and how the rest is to be read with it.
struct MjcfCompiler {
    bool degrees = true, autoLimits = true, stripPath = false;
    std::string eulerOrder = "xyz", meshFolder;

    double angle(double value) const;
};

/// The model with all that it includes in the places where it does: each file once, 64 at most, 8 MiB
/// together. The places of what is included are asked of the files returned, which must be kept for that.
std::list<XmlFile> includeAll(tinyxml2::XMLElement& model, const std::string& file,
                              const ReadOther& readOther);

MjcfCompiler readCompiler(const tinyxml2::XMLElement& model, const std::string& file);

/// Gives each geom, joint and mesh the attributes of its default class that it has none of its own for.
void applyDefaults(tinyxml2::XMLElement& model, const std::string& file);

/// The turn that takes z to a direction, as MuJoCo does.
Eigen::Quaterniond turnOfZ(const Vec3& z);

/// Where an element stands in its parent: pos, and one of quat, axisangle, xyaxes, zaxis, euler.
Pose placeOfElement(const tinyxml2::XMLElement& element, const std::string& file,
                    const MjcfCompiler& compiler);

} // namespace tss
