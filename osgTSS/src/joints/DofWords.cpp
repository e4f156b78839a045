#include "DofWords.h"

#include "bake/base/Error.h"
#include "bake/motion/DofUnits.h"
#include "bake/scene/DofToken.h"

#include <cmath>
#include <sstream>

namespace osgTSS {

namespace {

tss::Dof parseDofWord(const std::string& word, const std::string& tag) {
    std::istringstream text(word);
    std::string token;
    double lower = 0, upper = 0;
    char colon = 0;
    tss::Dof dof;
    std::size_t path = 0;
    std::getline(text, token, ':');
    text >> lower >> colon >> upper;
    if (text.fail() || colon != ':' || text.peek() != EOF || !tss::dofFromToken(token, dof, path) ||
        dof.kind == tss::DofKind::Path || !(lower <= upper) || !std::isfinite(lower) || !std::isfinite(upper))
        throw tss::InputError(tag + ": expected words such as rotZ:-24:18 or transX:0:5, found \"" + word +
                              "\"");
    dof.name = token;
    dof.lower = tss::fromUser(dof, lower);
    dof.upper = tss::fromUser(dof, upper);
    return dof;
}

} // namespace

std::vector<tss::Dof> parseDofWords(const std::string& words, const std::string& tag) {
    std::istringstream text(words);
    std::vector<tss::Dof> dofs;
    for (std::string word; text >> word;) dofs.push_back(parseDofWord(word, tag));
    return dofs;
}

} // namespace osgTSS
