#pragma once
#include "bake/model/SceneModel.h"

#include <string>
#include <vector>

/// A joint, with what it is asked for and what it has, as one line of words: numbers in their shortest form
/// that reads back the same bits (OSG's own text rounds to 6 digits), counts before lists, names after "=".
struct JointText {
    tss::Joint joint; ///< bodies are left out
    std::vector<double> asked, values;
};

std::string writeJointText(const JointText& text);

/// Throws tss::InputError where the line is not one that writeJointText() makes.
JointText readJointText(const std::string& line);
