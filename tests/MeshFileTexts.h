#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

/// The smallest files of some formats: a tetrahedron with an edge of 1, 2 and 3 units along x, y and z.
namespace tss::test {

/// upAxis: 'Y' or 'Z'. Its unit is the metre.
inline std::string tetrahedronCollada(char upAxis) {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>)" +
           std::string(1, upAxis) + R"(_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

/// Its unit is the inch.
inline std::string tetrahedronFbx(char upAxis) {
    return fmt::format(R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {{
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}}
GlobalSettings:  {{
	Version: 1000
	Properties70:  {{
		P: "UpAxis", "int", "Integer", "",{}
		P: "UnitScaleFactor", "double", "Number", "",2.54
	}}
}}
Objects:  {{
	Geometry: 100, "Geometry::g", "Mesh" {{
		Vertices: *12 {{
			a: 0,0,0,1,0,0,0,2,0,0,0,3
		}}
		PolygonVertexIndex: *12 {{
			a: 0,2,-2,0,1,-4,0,3,-3,1,2,-4
		}}
	}}
	Model: 200, "Model::m", "Mesh" {{
		Version: 232
	}}
}}
Connections:  {{
	C: "OO",200,0
	C: "OO",100,200
}}
)",
                       upAxis - 'X');
}

/// attribute: of its root, as ` unit="inch"`.
inline std::string tetrahedronAmf(const std::string& attribute) {
    std::string xml = "<?xml version=\"1.0\"?>\n<amf" + attribute + "><object id=\"1\"><mesh><vertices>";
    for (const char* v : {"<x>0</x><y>0</y><z>0</z>", "<x>1</x><y>0</y><z>0</z>", "<x>0</x><y>2</y><z>0</z>",
                          "<x>0</x><y>0</y><z>3</z>"})
        xml += "<vertex><coordinates>" + std::string(v) + "</coordinates></vertex>";
    xml += "</vertices><volume>";
    for (const char* t : {"<v1>0</v1><v2>2</v2><v3>1</v3>", "<v1>0</v1><v2>1</v2><v3>3</v3>",
                          "<v1>0</v1><v2>3</v2><v3>2</v3>", "<v1>1</v1><v2>2</v2><v3>3</v3>"})
        xml += "<triangle>" + std::string(t) + "</triangle>";
    return xml + "</volume></mesh></object></amf>";
}

/// A ZIP archive of files that are not packed.
inline std::string zipped(const std::vector<std::pair<std::string, std::string>>& files) {
    const auto bytes = [](std::uint64_t number, int count) {
        std::string text;
        for (int k = 0; k < count; ++k, number >>= 8) text += static_cast<char>(number & 0xff);
        return text;
    };
    const auto checksum = [](const std::string& text) {
        std::uint32_t crc = ~0u;
        for (const char c : text) {
            crc ^= static_cast<unsigned char>(c);
            for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
        return ~crc;
    };
    std::string archive, directory;
    for (const auto& [name, text] : files) {
        const std::string about = bytes(20, 2) + bytes(0, 8) + bytes(checksum(text), 4) +
                                  bytes(text.size(), 4) + bytes(text.size(), 4) + bytes(name.size(), 2) +
                                  bytes(0, 2);
        directory += "PK\1\2" + bytes(20, 2) + about + bytes(0, 10) + bytes(archive.size(), 4) + name;
        archive += "PK\3\4" + about + name + text;
    }
    return archive + directory + "PK\5\6" + bytes(0, 4) + bytes(files.size(), 2) + bytes(files.size(), 2) +
           bytes(directory.size(), 4) + bytes(archive.size(), 4) + bytes(0, 2);
}

/// attribute: of its model, as ` unit="inch"`; more: items of its build.
inline std::string tetrahedron3mf(const std::string& attribute, const std::string& more = "") {
    const std::string core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
                      package = "http://schemas.openxmlformats.org/package/2006/relationships";
    std::string model = "<?xml version=\"1.0\"?>\n<model" + attribute + " xmlns=\"" + core + "\">";
    model += "<resources><object id=\"1\" type=\"model\"><mesh><vertices>";
    for (const char* v : {"x=\"0\" y=\"0\" z=\"0\"", "x=\"1\" y=\"0\" z=\"0\"", "x=\"0\" y=\"2\" z=\"0\"",
                          "x=\"0\" y=\"0\" z=\"3\""})
        model += "<vertex " + std::string(v) + "/>";
    model += "</vertices><triangles>";
    for (const char* t : {"v1=\"0\" v2=\"2\" v3=\"1\"", "v1=\"0\" v2=\"1\" v3=\"3\"",
                          "v1=\"0\" v2=\"3\" v3=\"2\"", "v1=\"1\" v2=\"2\" v3=\"3\""})
        model += "<triangle " + std::string(t) + "/>";
    model +=
        "</triangles></mesh></object></resources><build><item objectid=\"1\"/>" + more + "</build></model>";
    return zipped({{"_rels/.rels", "<?xml version=\"1.0\"?>\n<Relationships xmlns=\"" + package +
                                       "\"><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" Type=\"" +
                                       "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>"
                                       "</Relationships>"},
                   {"3D/3dmodel.model", model}});
}

/// An entity of a DXF.
inline std::string dxfFace(const Vec3& a, const Vec3& b, const Vec3& c) {
    std::string text = "0\n3DFACE\n8\n0\n";
    int corner = 0;
    for (const Vec3& v : {a, b, c, c}) {
        for (int k = 0; k < 3; ++k) text += fmt::format("{}\n{}\n", 10 * (k + 1) + corner, v[k]);
        ++corner;
    }
    return text;
}

} // namespace tss::test
