// Reads stages with OpenUSD and with readStage(), and says where a prim is another: compare_openusd
// FILE.usda... Exit status 1 where one of them differs, or where OpenUSD finds an error in one.
#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/robot/MeshFiles.h"
#include "bake/usd/Stage.h"

#include <fmt/format.h>
#include <pxr/base/tf/diagnosticMgr.h>
#include <pxr/base/tf/error.h>
#include <pxr/base/tf/warning.h>
#include <pxr/usd/usd/attribute.h>
#include <pxr/usd/usd/prim.h>
#include <pxr/usd/usd/primTypeInfo.h>
#include <pxr/usd/usd/relationship.h>
#include <pxr/usd/usd/stage.h>
#include <set>

namespace {

using Lines = std::set<std::string>; ///< what is said of each prim and property

/// An undefined prim is one, over or class.
std::string primLine(const std::string& path, bool defined, const std::string& type,
                     const std::vector<std::string>& schemas) {
    return fmt::format("{} {} {} [{}]", path, defined ? "def" : "over", type, fmt::join(schemas, " "));
}

void addOwn(const tss::Prim& prim, const std::string& path, Lines& lines) {
    if (const auto active = prim.metadata.find("active");
        active != prim.metadata.end() && active->second == tss::Value(false))
        return;
    const auto schemas = prim.metadata.find("apiSchemas");
    lines.insert(primLine(path, prim.specifier == "def", prim.typeName,
                          schemas == prim.metadata.end() ? std::vector<std::string>{}
                                                         : tss::listItems(schemas->second)));
    for (const auto& [name, property] : prim.properties) {
        const std::string at = path + "." + name;
        if (property.isRelationship())
            for (const std::string& target : tss::listItems(*property.targetPaths))
                lines.insert(at + " -> " + target);
        const double* number = property.defaultValue ? property.defaultValue->as<double>() : nullptr;
        if (number) lines.insert(fmt::format("{} = {}", at, *number));
        for (const auto& sample : property.timeSamples)
            if (const double* value = sample.value.as<double>())
                lines.insert(fmt::format("{} at {} = {}", at, sample.time, *value));
    }
    for (const tss::Prim& child : prim.children) addOwn(child, path + "/" + child.name, lines);
}

std::optional<double> numberOf(pxr::VtValue value) {
    if (value.IsHolding<bool>() || !value.Cast<double>().IsHolding<double>()) return std::nullopt;
    return value.Get<double>();
}

void addTheirs(const pxr::UsdPrim& prim, Lines& lines) {
    if (!prim.IsActive()) return;
    const std::string path = prim.GetPath().GetString();
    std::vector<std::string> schemas;
    for (const pxr::TfToken& schema : prim.GetPrimTypeInfo().GetAppliedAPISchemas())
        schemas.push_back(schema.GetString());
    lines.insert(
        primLine(path, prim.GetSpecifier() == pxr::SdfSpecifierDef, prim.GetTypeName().GetString(), schemas));
    for (const pxr::UsdProperty& property : prim.GetAuthoredProperties()) {
        const std::string at = path + "." + property.GetName().GetString();
        if (const auto relationship = property.As<pxr::UsdRelationship>()) {
            pxr::SdfPathVector targets;
            relationship.GetTargets(&targets);
            for (const pxr::SdfPath& target : targets) lines.insert(at + " -> " + target.GetString());
            continue;
        }
        const auto attribute = property.As<pxr::UsdAttribute>();
        pxr::VtValue value;
        const auto written = attribute.GetResolveInfo(pxr::UsdTimeCode::Default()).GetSource();
        if (written == pxr::UsdResolveInfoSourceDefault && attribute.Get(&value, pxr::UsdTimeCode::Default()))
            if (const auto number = numberOf(value)) lines.insert(fmt::format("{} = {}", at, *number));
        std::vector<double> times;
        attribute.GetTimeSamples(&times);
        for (const double time : times)
            if (attribute.Get(&value, time))
                if (const auto number = numberOf(value))
                    lines.insert(fmt::format("{} at {} = {}", at, time, *number));
    }
    for (const pxr::UsdPrim& child : prim.GetAllChildren()) addTheirs(child, lines);
}

/// Counts what OpenUSD calls an error.
struct Errors : pxr::TfDiagnosticMgr::Delegate {
    void IssueError(const pxr::TfError& error) override {
        fmt::print("OpenUSD: {}\n", error.GetCommentary());
        ++count;
    }
    void IssueFatalError(const pxr::TfCallContext&, const std::string& text) override {
        fmt::print("OpenUSD: {}\n", text);
        ++count;
    }
    void IssueStatus(const pxr::TfStatus&) override {}
    void IssueWarning(const pxr::TfWarning&) override {} // of what is left out, which is said here too
    int count = 0;
};

bool same(const std::string& file) {
    Lines own, theirs;
    const auto stage = pxr::UsdStage::Open(file);
    if (!stage) return false;
    addTheirs(stage->GetPseudoRoot(), theirs);
    theirs.erase(primLine("/", true, "", {}));
    for (const tss::Prim& prim :
         tss::readStage(tss::readWholeFile(file), file, tss::besideUsd(tss::meshesOf(file, {})))
             .layer.children)
        addOwn(prim, "/" + prim.name, own);
    if (own == theirs) return true;
    int said = 0;
    for (const auto& [ours, others, whose] :
         {std::tuple(&own, &theirs, "here"), std::tuple(&theirs, &own, "OpenUSD")})
        for (const std::string& line : *ours)
            if (!others->contains(line) && ++said <= 6) fmt::print("{}: {}: {}\n", file, whose, line);
    return false;
}

} // namespace

int main(int count, char** files) {
    Errors errors;
    pxr::TfDiagnosticMgr::GetInstance().AddDelegate(&errors);
    int differ = 0;
    for (int k = 1; k < count; ++k) differ += !same(files[k]);
    fmt::print("{} stages, {} differ, {} errors of OpenUSD\n", count - 1, differ, errors.count);
    pxr::TfDiagnosticMgr::GetInstance().RemoveDelegate(&errors);
    return differ > 0 || errors.count > 0;
}
