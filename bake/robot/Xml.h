#pragma once
#include "bake/base/Error.h"

#include <memory>
#include <string>
#include <tinyxml2.h>
#include <vector>

namespace tss {

/// Where an element of the file stands, for a message: "line 12", and its name with that of its `name`
/// attribute. Of what insertCopies() made: in the file that it was copied from.
Where placeOf(const std::string& file, const tinyxml2::XMLElement& element);

/// Its line alone: "line 12", or "line 12 of parts.xml" where it was copied from there.
std::string lineOf(const std::string& file, const tinyxml2::XMLElement& element);

struct XmlFile {
    std::string name;
    std::unique_ptr<tinyxml2::XMLDocument> document;
};

/// Copies what the root of another file holds into a document, behind an element of it; the first copy, null
/// where there is none. The file must stay where it is for as long as places of the copies are asked.
tinyxml2::XMLElement* insertCopies(tinyxml2::XMLElement& behind, XmlFile& from);

/// The tree of an XML text whose elements know their lines. Refused with an InputError that names the file
/// and the line: more than 8 MiB, not UTF-8, not well formed, a document type (no entity is ever expanded),
/// an attribute given twice, elements more than 100 deep or more than
/// 100000 of them, xacro (with the command that expands it), a root of
/// another name (any will do where none is given).
std::unique_ptr<tinyxml2::XMLDocument> parseXml(const std::string& text, const std::string& file,
                                                const std::string& root);

/// The attribute, or the fallback where there is none.
std::string textOf(const tinyxml2::XMLElement& element, const char* attribute,
                   const std::string& fallback = "");

/// Numbers apart by blanks; empty where the attribute is absent. Throws InputError for what is no finite
/// number, or for another count than from `least` to `most`.
std::vector<double> numbersOf(const std::string& file, const tinyxml2::XMLElement& element,
                              const char* attribute, std::size_t least, std::size_t most);

} // namespace tss
