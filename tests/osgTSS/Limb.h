#pragma once
#include "Playback.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osg/ValueObject>
#include <osgSim/DOFTransform>

#include <cmath>

/// A limb as an application may have it: two bones in a row along x, the second on a hinge about y, a muscle
/// on the first, and a skin around all that is textured, so that it has a seam. Tags say what is what.
class Limb {
public:
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    osg::ref_ptr<osgSim::DOFTransform> hinge = new osgSim::DOFTransform;
    osg::ref_ptr<osg::Geometry> skin, muscle;
    osg::ref_ptr<osg::Geode> skinGeode = new osg::Geode, muscleGeode = new osg::Geode;

    static constexpr int rings = 33, sides = 16;
    static constexpr float length = 4, radius = 0.5f;

    /// across: the muscle goes over the elbow to the other bone.
    explicit Limb(const osg::Matrixd& matrix = osg::Matrixd(), bool across = false) {
        place->setMatrix(matrix);
        root->addChild(place);
        hinge->setName("Hinge");
        hinge->setCurrentScale(osg::Vec3(1, 1, 1));
        hinge->setLimitationFlags(0xff800000ul);
        hinge->setMinHPR(osg::Vec3());
        hinge->setMaxHPR(osg::Vec3(0, 0, osg::DegreesToRadians(80.f)));
        const osg::Matrixd elbow = osg::Matrixd::translate(2, 0, 0);
        hinge->setPutMatrix(osg::Matrixd::inverse(elbow)); // to the hinge
        hinge->setInversePutMatrix(elbow);
        hinge->setAnimationOn(false);
        place->addChild(bone("Humerus", tube(0.2f, 1.9f, 9, 8, 0.15f, false)));
        hinge->addChild(bone("Ulna", tube(2.1f, 3.8f, 9, 8, 0.15f, false)));
        place->addChild(hinge);

        muscle = tube(0.4f, across ? 2.8f : 1.6f, 13, 12, 0.0f, false);
        muscle->setName("Biceps");
        muscle->setUserValue("osgTSS:muscle", std::string(across ? "contract=0.2 to=Ulna" : "contract=0.2"));
        muscleGeode->addDrawable(muscle);
        place->addChild(muscleGeode);

        skin = tube(0, length, rings, sides, radius, true);
        skin->setName("Sleeve");
        skin->setUserValue("osgTSS:skin", true);
        osg::ref_ptr<osg::StateSet> state = skin->getOrCreateStateSet();
        state->setTextureAttributeAndModes(0, new osg::Texture2D);
        skinGeode->addDrawable(skin);
        place->addChild(skinGeode);
    }

    void bend(double degrees) {
        hinge->setCurrentHPR(osg::Vec3(0, 0, static_cast<float>(osg::DegreesToRadians(degrees))));
    }

    /// Of a vertex of the skin: its ring and its place round it. The last side is the first once more.
    static unsigned int at(int ring, int side) {
        return static_cast<unsigned int>(ring * (sides + 1) + side);
    }

    /// Closed at its ends by caps of a vertex. radius 0: a belly, spindle-shaped. seam: textured, with the
    /// first side twice.
    static osg::ref_ptr<osg::Geometry> tube(float from, float to, int rings, int sides, float radius,
                                            bool seam) {
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
        osg::ref_ptr<osg::Vec2Array> texture = new osg::Vec2Array;
        const int columns = sides + (seam ? 1 : 0);
        for (int r = 0; r < rings; ++r)
            for (int s = 0; s < columns; ++s) {
                const double share = double(r) / (rings - 1), angle = 2 * osg::PI * (s % sides) / sides;
                const double thick = radius > 0 ? radius : 0.06 + 0.16 * std::sin(osg::PI * share);
                const double off = radius > 0 ? 0 : 0.2;
                const osg::Vec3d out(0, std::cos(angle), std::sin(angle));
                vertices->push_back(osg::Vec3(osg::Vec3d(from + (to - from) * share, 0, off) + out * thick));
                normals->push_back(osg::Vec3(out));
                texture->push_back(osg::Vec2(float(share), float(s) / float(sides)));
            }
        osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
        const auto index = [&](int r, int s) {
            return static_cast<unsigned int>(r * columns + (seam ? s : s % sides));
        };
        for (int r = 0; r + 1 < rings; ++r)
            for (int s = 0; s < sides; ++s)
                for (const unsigned int v : {index(r, s), index(r, s + 1), index(r + 1, s), index(r + 1, s),
                                             index(r, s + 1), index(r + 1, s + 1)})
                    triangles->push_back(v);
        for (const int r : {0, rings - 1}) {
            const auto centre = static_cast<unsigned int>(vertices->size());
            osg::Vec3 middle;
            for (int s = 0; s < sides; ++s) middle += (*vertices)[index(r, s)] / float(sides);
            vertices->push_back(middle);
            normals->push_back(osg::Vec3(r == 0 ? -1.f : 1.f, 0, 0));
            texture->push_back(osg::Vec2(r == 0 ? 0.f : 1.f, 0.5f));
            for (int s = 0; s < sides; ++s)
                for (const unsigned int v :
                     {centre, index(r, r == 0 ? s + 1 : s), index(r, r == 0 ? s : s + 1)})
                    triangles->push_back(v);
        }
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setVertexArray(vertices);
        geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        if (seam) geometry->setTexCoordArray(0, texture);
        geometry->addPrimitiveSet(triangles);
        return geometry;
    }

private:
    osg::ref_ptr<osg::Geode> bone(const char* name, const osg::ref_ptr<osg::Geometry>& shape) {
        osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->setName(name);
        geode->addDrawable(shape);
        geode->setUserValue("osgTSS:bone", true);
        return geode;
    }
};
