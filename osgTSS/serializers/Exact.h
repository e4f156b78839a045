#pragma once
#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <string>
#include <vector>

/// Lists of numbers that come back bit for bit from .osgt, .osgb and .osgx alike: written as text, shortest
/// form. OSG's own text rounds to 6 digits.
std::string exactText(const std::vector<double>& values);

/// Throws through the stream where the text is no list of numbers of this length (any length for -1).
std::vector<double> exactValues(osgDB::InputStream& is, int count = -1);

inline void writeExact(osgDB::OutputStream& os, const std::vector<double>& values) {
    os.writeWrappedString(exactText(values));
}

/// A name that may be empty.
void writeName(osgDB::OutputStream& os, const std::string& name);
std::string readName(osgDB::InputStream& is);
