#pragma once
#include "Limb.h"
#include "Rigged.h"

#include <osgTSS/SkinGeometry>

#include <functional>

/// Bones in a row along x and a rigged sleeve around them.
class Character : public Rigged {
public:
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    osg::ref_ptr<osg::Geometry> source =
        Limb::tube(0, Limb::length, Limb::rings, Limb::sides, Limb::radius, true);
    osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences = new osgAnimation::VertexInfluenceMap;
    Playback playback;

    /// shares: of each bone in a point of the sleeve. words: of the skin that it is tagged as; null: none.
    /// Then the keys play.
    void dress(const std::function<std::map<std::string, float>(const osg::Vec3&)>& shares,
               const char* words) {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*source->getVertexArray());
        for (unsigned int v = 0; v < vertices.size(); ++v)
            for (const auto& [bone, share] : shares(vertices[v]))
                if (share > 0) (*influences)[bone].emplace_back(v, share);
        for (auto& [name, influence] : *influences) influence.setName(name);
        rig->setName("Sleeve");
        rig->setSourceGeometry(source);
        rig->setInfluenceMap(influences);
        if (words) rig->setUserValue("osgTSS:skin", std::string(words));
        geode->addDrawable(rig);
        skeleton->addChild(geode);
        manager->registerAnimation(animation);
        manager->playAnimation(animation);
    }

    void frame(unsigned int number) { playback.frame(*root, number); }

    /// What is drawn.
    const osg::Vec3Array& drawn() const {
        auto* skin = dynamic_cast<osgTSS::SkinGeometry*>(geode->getDrawable(0));
        return skin ? *skin->getVertices() : static_cast<const osg::Vec3Array&>(*rig->getVertexArray());
    }

    /// The farthest that a vertex that one bone alone holds is from where another one of its kind draws it.
    double off(const Character& other) const {
        double most = 0;
        for (const auto& [bone, influence] : *influences)
            for (const auto& [vertex, weight] : influence)
                if (weight > 0.999f)
                    most = std::max<double>(most, (drawn()[vertex] - other.drawn()[vertex]).length());
        return most;
    }
};
