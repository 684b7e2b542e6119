/* The glue between the soft bodies of Bullet and cscd. docs/solver/in-your-engine.md shows all that follows the includes. */
#pragma once

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <cscd/cscd.hpp>

#include <array>
#include <optional>
#include <vector>

template <> struct cscd::scalar_of<btVector3> { using type = btScalar; };

/* The surface of a rigid body, and its vertices at the begin and at the end of a step. */
struct obstacle_surface {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<btVector3> from, to;
};

/* Soft bodies of a world and its obstacles, where Bullet keeps them. These outlive it, and add or remove no vertex. */
struct safe_bodies {
    std::vector<cscd::span<btSoftBody::Node>> bodies;
    std::vector<double> inverse_masses, friction;
    std::vector<cscd_view> from, to; /* one for each object */
    std::vector<cscd_mutable_view> reached;
    cscd::context context;
    std::optional<cscd::mesh> mesh;
    std::optional<cscd::detector> detector;

    safe_bodies(cscd::span<btSoftBody *const> soft, cscd::span<obstacle_surface> obstacles, double separation,
                double coefficient) {
        std::vector<std::vector<std::uint32_t>> triangles;
        std::vector<cscd_object_desc> objects;
        for (btSoftBody *body : soft) {
            const cscd::span<btSoftBody::Node> nodes(&body->m_nodes[0], std::size_t(body->m_nodes.size()));
            std::vector<std::uint32_t> &corners = triangles.emplace_back();
            for (int i = 0; i < body->m_faces.size(); i++)
                for (const btSoftBody::Node *node : body->m_faces[i].m_n)
                    corners.push_back(std::uint32_t(node - nodes.data()));
            for (const btSoftBody::Node &node : nodes) inverse_masses.push_back(node.m_im);
            objects.push_back(cscd::object_of_triangles(std::uint32_t(nodes.size()), corners));
            add_views(cscd::view_of(nodes, &btSoftBody::Node::m_q),
                      cscd::view_of(nodes, &btSoftBody::Node::m_x));
            bodies.push_back(nodes);
        }
        for (obstacle_surface &o : obstacles) {
            inverse_masses.resize(inverse_masses.size() + o.from.size());
            objects.push_back(cscd::obstacle_of_triangles(std::uint32_t(o.from.size()), o.triangles));
            add_views(cscd::view_of(o.from), cscd::view_of(o.to));
        }
        friction.resize(objects.size(), coefficient);
        cscd::detector_options options;
        options.min_separation = separation;
        mesh.emplace(context, objects);
        detector.emplace(context, *mesh, options);
    }

    void add_views(cscd::mutable_view start, cscd::mutable_view end) {
        start.object_count = end.object_count = 1;
        from.push_back(start);
        to.push_back(end);
        reached.push_back(end);
    }

    /* Follows stepSimulation: all go on to where nothing has touched on the way. */
    cscd_safe_motion end_step(btScalar seconds) {
        cscd_response_options options = cscd_response_defaults();
        options.inverse_masses = inverse_masses.data();
        options.friction = friction.data();
        const cscd_safe_motion safe = detector->make_safe(from, to, reached, options);
        for (const auto &nodes : bodies)
            for (btSoftBody::Node &node : nodes) node.m_v = (node.m_x - node.m_q) / seconds;
        return safe;
    }
};
