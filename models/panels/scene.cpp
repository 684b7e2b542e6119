/* The scene: two panels of cloth, sewn together, a ball and a floor. */
#include "models/panels/panels.hpp"

#include <algorithm>
#include <map>

namespace panels {

namespace {

constexpr float ball_radius = 0.25f, cloth_mass = 0.3f, ball_mass = 0.4f;

/* The square from x = left to left + 1, with vertices row by row. */
object make_panel(std::uint32_t side, float left) {
    object panel;
    const float step = 1.0f / static_cast<float>(side);
    for (std::uint32_t j = 0; j <= side; j++) {
        for (std::uint32_t i = 0; i <= side; i++)
            panel.points.push_back(
                {left + step * static_cast<float>(i), step * static_cast<float>(j) - 0.5f, 0.0f});
    }
    const std::uint32_t row = side + 1;
    for (std::uint32_t j = 0; j < side; j++) {
        for (std::uint32_t i = 0; i < side; i++) {
            const std::uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
            if ((i + j) % 2 == 0) {
                panel.triangles.push_back({a, b, d});
                panel.triangles.push_back({a, d, c});
            } else {
                panel.triangles.push_back({a, b, c});
                panel.triangles.push_back({b, d, c});
            }
        }
    }
    return panel;
}

/* The vertex in the middle of an edge of the sphere. */
std::uint32_t middle_of(object &ball, std::map<pair, std::uint32_t> &known, std::uint32_t a,
                        std::uint32_t b) {
    const auto place = known.find({std::min(a, b), std::max(a, b)});
    if (place != known.end()) return place->second;
    const vec3 sum = ball.points[a] + ball.points[b];
    ball.points.push_back((ball_radius / length(sum)) * sum);
    const auto made = static_cast<std::uint32_t>(ball.points.size() - 1);
    known[{std::min(a, b), std::max(a, b)}] = made;
    return made;
}

/* An octahedron, each of whose triangles is divided in four, three times. */
object make_ball() {
    const float r = ball_radius;
    object ball{{{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
                {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int level = 0; level < 3; level++) {
        std::map<pair, std::uint32_t> known;
        std::vector<triple> finer;
        for (const triple &t : ball.triangles) {
            const std::uint32_t a = middle_of(ball, known, t[0], t[1]),
                                b = middle_of(ball, known, t[1], t[2]),
                                c = middle_of(ball, known, t[2], t[0]);
            finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
        }
        ball.triangles = finer;
    }
    for (vec3 &point : ball.points) point.z += 0.4f;
    return ball;
}

/* A box of 2.4 x 1.6 x 0.2, whose upper side lies at z = -0.9. */
object make_floor() {
    object box;
    for (int i = 0; i < 8; i++)
        box.points.push_back({i & 1 ? 1.2f : -1.2f, i & 2 ? 0.8f : -0.8f, i & 4 ? -0.9f : -1.1f});
    box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return box;
}

float inverse_mass_of(std::uint32_t which, const object &o, const vec3 &point) {
    const float count = static_cast<float>(o.points.size());
    if (which == FLOOR || (which == LEFT_PANEL && point.x == -1.0f) ||
        (which == RIGHT_PANEL && point.x == 1.0f))
        return 0.0f;
    return count / (which == BALL ? ball_mass : cloth_mass);
}

void place_particles(scene &s) {
    for (std::uint32_t which = 0; which < OBJECTS; which++) {
        for (const vec3 &point : s.objects[which].points)
            s.particles.push_back({point, {}, point, inverse_mass_of(which, s.objects[which], point)});
    }
}

/* The springs of a panel: along its edges, and across each edge between two triangles. */
void add_springs(const std::vector<particle> &particles, const std::vector<triple> &triangles,
                 std::uint32_t first_vertex, std::vector<spring> &out) {
    std::map<pair, std::uint32_t> opposite; /* of an edge that one triangle has shown */
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
        out.push_back({a, b, length(particles[a].rest - particles[b].rest)});
    };
    for (const triple &t : triangles) {
        for (std::size_t i = 0; i < 3; i++) {
            const std::uint32_t a = first_vertex + t[i], b = first_vertex + t[(i + 1) % 3],
                                c = first_vertex + t[(i + 2) % 3];
            const auto known = opposite.find({std::min(a, b), std::max(a, b)});
            if (known != opposite.end()) {
                add(known->second, c);
            } else {
                add(a, b);
                opposite[{std::min(a, b), std::max(a, b)}] = c;
            }
        }
    }
}

} // namespace

void number_vertices(scene &s) {
    s.first[0] = 0;
    for (std::uint32_t which = 0; which < OBJECTS; which++)
        s.first[which + 1] = s.first[which] + static_cast<std::uint32_t>(s.objects[which].points.size());
}

void make_springs(scene &s) {
    s.springs.clear();
    for (std::uint32_t which : {LEFT_PANEL, RIGHT_PANEL})
        add_springs(s.particles, s.objects[which].triangles, s.first[which], s.springs);
}

tear tear_panel(scene &s) {
    object &panel = s.objects[RIGHT_PANEL];
    tear done;
    std::map<std::uint32_t, std::uint32_t> upper; /* of a vertex on the tear */
    float row = -1.0f;                            /* the y of its vertices */
    for (const vec3 &point : panel.points) row = std::fabs(point.y) < std::fabs(row) ? point.y : row;
    for (std::uint32_t v = 0; v < panel.points.size(); v++) done.origins.push_back(v);
    for (std::uint32_t v : done.origins) {
        const vec3 &point = panel.points[v];
        if (point.y != row || point.x > 0.66f) continue;
        upper[v] = static_cast<std::uint32_t>(done.origins.size() + done.sides.size());
        done.sides.push_back({v, upper[v]});
    }
    for (const pair &side : done.sides) {
        panel.points.push_back(panel.points[side[0]]);
        done.origins.push_back(side[0]);
    }
    for (triple &t : panel.triangles) {
        const float middle = panel.points[t[0]].y + panel.points[t[1]].y + panel.points[t[2]].y;
        for (std::uint32_t &v : t) {
            if (middle > 3.0f * row && upper.count(v) > 0) v = upper[v];
        }
    }
    number_vertices(s);
    return done;
}

scene make_scene(std::uint32_t side) {
    scene s;
    s.objects = {make_panel(side, -1.0f), make_panel(side, 0.0f), make_ball(), make_floor()};
    number_vertices(s);
    place_particles(s);
    for (std::uint32_t j = 0; j <= side; j++)
        s.seams.push_back(
            {s.first[LEFT_PANEL] + j * (side + 1) + side, s.first[RIGHT_PANEL] + j * (side + 1)});
    make_springs(s);
    for (const vec3 &point : s.objects[BALL].points) s.ball_shape.push_back(point - vec3{0.0f, 0.0f, 0.4f});
    return s;
}

vec3 floor_sway(float seconds) {
    return {0.1f * std::sin(2.0f * seconds), 0.0f, 0.05f * std::sin(3.0f * seconds)};
}

} // namespace panels
