#include "bake/robot/Xml.h"

#include "bake/scene/Utf8.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

namespace tss {

using tinyxml2::XMLElement;

namespace {

constexpr std::size_t mostBytes = 8 << 20; ///< a tree takes some 30 times that
constexpr int mostLevels = 100, mostElements = 100000;

std::string lineText(int line) {
    return "line " + std::to_string(line);
}

void refuseXacro(const std::string& file, const XMLElement& element, const char* found) {
    std::string to = file.ends_with(".xacro") ? file.substr(0, file.size() - 6) : file;
    if (to == file && to.ends_with(".urdf")) to = to.substr(0, to.size() - 5) + "_expanded";
    if (!to.ends_with(".urdf")) to += ".urdf";
    throw InputError(placeOf(file, element),
                     std::string("\"") + found +
                         "\" is xacro, a language of macros; expected what it expands to: xacro " + file +
                         " > " + to);
}

void refuseMacros(const std::string& file, const XMLElement& element) {
    for (const auto* a = element.FirstAttribute(); a; a = a->Next()) {
        if (std::string_view(a->Value()).find("${") != std::string_view::npos)
            refuseXacro(file, element, a->Value());
    }
}

void checkElement(const std::string& file, const XMLElement& element, int level, int& count) {
    if (++count > mostElements)
        throw InputError(placeOf(file, element),
                         "expected no more than " + std::to_string(mostElements) + " elements");
    if (level > mostLevels)
        throw InputError(placeOf(file, element),
                         "expected elements no more than " + std::to_string(mostLevels) + " deep");
    if (std::string_view(element.Name()).starts_with("xacro:")) refuseXacro(file, element, element.Name());
    refuseMacros(file, element);
    for (const auto* child = element.FirstChild(); child; child = child->NextSibling()) {
        if (child->ToUnknown())
            throw InputError(Where{file, lineText(child->GetLineNum()), ""},
                             "expected elements, found <!" + std::string(child->Value()).substr(0, 40) + ">");
        if (const XMLElement* inner = child->ToElement()) checkElement(file, *inner, level + 1, count);
    }
}

void refuseDocumentType(const std::string& file, int line) {
    throw InputError(Where{file, lineText(line), ""},
                     "a document type is not read, and no entity is expanded; expected it to be left out");
}

std::string reasonOf(const tinyxml2::XMLDocument& document) {
    switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
        return "expected XML, found nothing";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
        return "expected elements no more than " + std::to_string(mostLevels) + " deep";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
        return "expected the end of the element that was begun last";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
        return "expected <?xml ...?> at the very beginning, before any comment, or nowhere";
    default:
        return "not well-formed XML (" + std::string(document.ErrorName()) + ")";
    }
}

} // namespace

Where placeOf(const std::string& file, const XMLElement& element) {
    if (const auto* original = static_cast<const XMLElement*>(element.GetUserData()))
        return placeOf(*static_cast<const std::string*>(original->GetDocument()->GetUserData()), *original);
    const std::string name = textOf(element, "name");
    return {file, lineText(element.GetLineNum()), element.Name() + (name.empty() ? "" : " " + name)};
}

std::string lineOf(const std::string& file, const XMLElement& element) {
    const Where at = placeOf(file, element);
    return at.file == file ? at.pointer : at.pointer + " of " + at.file;
}

XMLElement* insertCopies(XMLElement& behind, XmlFile& from) {
    const std::function<void(XMLElement&, XMLElement&)> remember = [&](XMLElement& copy,
                                                                       XMLElement& original) {
        copy.SetUserData(&original);
        auto* inner = original.FirstChildElement();
        for (auto* e = copy.FirstChildElement(); e;
             e = e->NextSiblingElement(), inner = inner->NextSiblingElement())
            remember(*e, *inner);
    };
    from.document->SetUserData(&from.name);
    XMLElement* first = nullptr;
    tinyxml2::XMLNode* last = &behind;
    for (auto* e = from.document->RootElement()->FirstChildElement(); e; e = e->NextSiblingElement()) {
        last = behind.Parent()->InsertAfterChild(last, e->DeepClone(behind.GetDocument()));
        remember(*last->ToElement(), *e);
        if (!first) first = last->ToElement();
    }
    return first;
}

std::unique_ptr<tinyxml2::XMLDocument> parseXml(const std::string& text, const std::string& file,
                                                const std::string& root) {
    if (text.size() > mostBytes) throw InputError(Where{file}, "expected no more than 8 MiB of XML");
    if (!isText(text)) throw InputError(Where{file}, "expected text in UTF-8");
    auto document = std::make_unique<tinyxml2::XMLDocument>();
    if (document->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
        if (const auto at = text.find("<!DOCTYPE"); at != text.npos)
            refuseDocumentType(file, 1 + static_cast<int>(std::count(text.begin(), text.begin() + at, '\n')));
        throw InputError(
            Where{file, document->ErrorLineNum() > 0 ? lineText(document->ErrorLineNum()) : "", ""},
            reasonOf(*document));
    }
    for (const auto* node = document->FirstChild(); node; node = node->NextSibling())
        if (node->ToUnknown()) refuseDocumentType(file, node->GetLineNum());
    const XMLElement* top = document->RootElement();
    if (!top) throw InputError(Where{file}, "expected an element <" + root + ">, found none");
    int count = 0;
    checkElement(file, *top, 1, count);
    if (!root.empty() && top->Name() != root)
        throw InputError(placeOf(file, *top), "expected <" + root + ">, found <" + top->Name() + ">");
    if (top->NextSiblingElement())
        throw InputError(placeOf(file, *top->NextSiblingElement()),
                         "expected one element <" + root + "> alone");
    return document;
}

std::string textOf(const XMLElement& element, const char* attribute, const std::string& fallback) {
    const char* text = element.Attribute(attribute);
    return text ? text : fallback;
}

std::vector<double> numbersOf(const std::string& file, const XMLElement& element, const char* attribute,
                              std::size_t least, std::size_t most) {
    std::vector<double> numbers;
    const char* text = element.Attribute(attribute);
    if (!text) return numbers;
    const auto wrong = [&]() -> InputError {
        const std::string count =
            least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most);
        return {placeOf(file, element), std::string(attribute) + ": expected " + count +
                                            (most == 1 ? " finite number" : " finite numbers") +
                                            ", found \"" + std::string(text).substr(0, 80) + "\""};
    };
    const std::string_view blanks = " \t\r\n";
    std::string_view rest = text;
    for (auto at = rest.find_first_not_of(blanks); at != rest.npos; at = rest.find_first_not_of(blanks)) {
        rest.remove_prefix(at);
        if (rest[0] == '+' && rest.substr(1, 1) != "-") rest.remove_prefix(1);
        double value = 0;
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        rest.remove_prefix(end - rest.data());
        const bool apart = rest.empty() || blanks.find(rest[0]) != blanks.npos;
        if (error != std::errc() || !apart || !std::isfinite(value) || numbers.size() == most) throw wrong();
        numbers.push_back(value);
    }
    if (numbers.size() < least) throw wrong();
    return numbers;
}

} // namespace tss
