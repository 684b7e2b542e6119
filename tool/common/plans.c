/* Finds a plan, in a file or by making it in memory, or none, and chooses the method that the detector then
 * uses. Reads how stiff triangles are, which plans by charge take into account, and colours triangles by
 * their plan. */
#include "tool/common/plans.h"

#include "tool/common/methods.h"
#include "tool/io/io.h"
#include "tool/io/ply.h"
#include "tool/io/text_encoding.h"
#include "tool/picture/picture.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *plan_path_of_model(const char *model_path) {
    static const char ending[] = ".plan.ply";
    const size_t length = strlen(model_path) - path_mesh_ending(model_path);
    char *path = malloc(length + sizeof ending);
    if (path == NULL) return NULL;
    memcpy(path, model_path, length);
    memcpy(path + length, ending, sizeof ending);
    return path;
}

const char *plan_source_name(plan_source source) {
    static const char *const names[] = {"none", "file", "memory"};
    return names[source];
}

static bool insists_on_plan(const plan_request *request) {
    return request->insists_on_plan || method_facts_of(request->method).insists_on_plan;
}

/* A method that makes no plans takes one of any method. So does a published one, but only if the caller names
 * it: what is not wholly as published is asked for. */
static bool method_fits(const plan_request *request, const cscd_plan *plan) {
    const method_facts facts = method_facts_of(request->method);
    const bool takes_any = !facts.makes_plan || (facts.insists_on_plan && request->plan_path != NULL);
    return takes_any || cscd_plan_method(plan) == request->method;
}

static void add_remark(plan_choice *choice, const char *text) {
    if (choice->remark[0] == '\0') snprintf(choice->remark, sizeof choice->remark, "%s", text);
}

/* A plan of another version is good, but perhaps not what this version would make. */
static void remark_version(plan_choice *choice, const cscd_plan *plan) {
    const char *origin = cscd_plan_describe(plan).origin,
               *version = origin != NULL ? strstr(origin, "version=") : NULL;
    char text[160];
    if (version != NULL) version += strlen("version=");
    const size_t length = version != NULL ? strcspn(version, " ") : 0;
    if (version != NULL && length == strlen(cscd_version_string()) &&
        memcmp(version, cscd_version_string(), length) == 0)
        return;
    if (version == NULL)
        add_remark(choice, "it does not say which version of cscd made it; cscd preprocess makes it anew");
    else {
        snprintf(text, sizeof text, "made by cscd %.*s; cscd preprocess makes it anew",
                 (int)(length < 40 ? length : 40), version);
        add_remark(choice, text);
    }
}

/* Takes the path over. */
static void choose_plan(plan_choice *choice, const plan_request *request, cscd_plan *plan, char *path) {
    choice->plan = plan;
    choice->method =
        method_facts_of(request->method).insists_on_plan ? request->method : cscd_plan_method(plan);
    choice->source = path != NULL ? PLAN_FROM_FILE : PLAN_FROM_MEMORY;
    if (path != NULL) remark_version(choice, plan);
    choice->path = path;
}

static bool read_named(const plan_request *request, const recording *r, plan_choice *choice,
                       io_error *error) {
    cscd_plan *plan = NULL;
    if (!plan_file_read(request->plan_path, r->context, r->mesh, &plan, error)) return false;
    char *path = strdup(request->plan_path);
    if (path != NULL && method_fits(request, plan)) {
        choose_plan(choice, request, plan, path);
        return true;
    }
    if (path == NULL)
        io_fail(error, "out of memory");
    else
        io_fail(error, "%s: the plan is of method %s, expected %s as --method says", path,
                cscd_method_name(cscd_plan_method(plan)), cscd_method_name(request->method));
    cscd_plan_destroy(plan);
    free(path);
    return false;
}

/* Takes the model's own plan, if there is one that fits; otherwise the remark says why not. */
static void try_model_plan(const plan_request *request, const recording *r, plan_choice *choice) {
    char *path = plan_path_of_model(request->model_path);
    cscd_plan *plan = NULL;
    io_error error = {""};
    if (path != NULL && access(path, F_OK) == 0) {
        if (!plan_file_read(path, r->context, r->mesh, &plan, &error)) {
            snprintf(choice->remark, sizeof choice->remark, "%.*s: left aside", TEXT_CUT(error.text, 560));
        } else if (method_fits(request, plan) && request->ours == 0) {
            choose_plan(choice, request, plan, path);
            return;
        } else if (method_fits(request, plan)) {
            snprintf(choice->remark, sizeof choice->remark,
                     "%.*s: left aside, since --ours says how to make one", TEXT_CUT(path, 500));
            cscd_plan_destroy(plan);
        } else {
            snprintf(choice->remark, sizeof choice->remark, "%.*s: left aside, it is of method %s",
                     TEXT_CUT(path, 500), cscd_method_name(cscd_plan_method(plan)));
            cscd_plan_destroy(plan);
        }
    }
    free(path);
}

/* Method auto goes on without the charge where that fails. */
static void remark_failure(plan_choice *choice, const cscd_plan *plan) {
    for (uint32_t i = 0; i < cscd_plan_describe(plan).compared_count; i++) {
        const char *failure = cscd_plan_compared(plan, i).failure;
        if (failure != NULL) add_remark(choice, failure);
    }
}

static bool make_plan(const plan_request *request, cscd_method method, const recording *r,
                      plan_choice *choice, io_error *error) {
    cscd_plan_options options = cscd_plan_defaults();
    options.method = method;
    if (request->k > 0) options.k = request->k;
    options.ours = request->ours;
    recorded_stiffness stiffness = {0};
    if ((method == CSCD_METHOD_CHARGE || method == CSCD_METHOD_AUTO) &&
        !recorded_stiffness_read(r, &stiffness, error))
        return false;
    options.stiffness = stiffness.of_triangle;
    double *positions = malloc((size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *positions);
    cscd_plan *plan = NULL;
    if (positions == NULL) {
        recorded_stiffness_free(&stiffness);
        return io_fail(error, "out of memory");
    }
    recording_rest(r, positions);
    bool made =
        cscd_plan_create(r->context, r->mesh, CSCD_DOUBLES(positions, cscd_mesh_vertex_count(r->mesh)),
                         &options, &plan) == CSCD_OK;
    if (made) {
        choose_plan(choice, request, plan, NULL);
        choice->made_ms = cscd_plan_timings(plan).total_ms;
        remark_failure(choice, plan);
    } else {
        io_fail(error, "%s: %s", request->model_path, cscd_context_detail(r->context));
    }
    free(positions);
    recorded_stiffness_free(&stiffness);
    return made;
}

static bool any_closed(const cscd_mesh *mesh) {
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++) {
        if (cscd_mesh_component(mesh, i).closed_manifold) return true;
    }
    return false;
}

/* By numbers of triangles and intervals, never by clock, so that all shards of a recording choose the
 * same. */
static bool charge_pays(const recording *r) {
    return cscd_mesh_triangle_count(r->mesh) <= PLAN_FEW_TRIANGLES ||
           r->frame_count > 10 * PLAN_PRICE_INTERVALS; /* intervals: one less */
}

/* No plan was asked for, so failures are not errors: if charge fails, there is one region per component;
 * if that fails too, nothing is culled. */
static bool make_best(const plan_request *request, const recording *r, plan_choice *choice, io_error *error) {
    char text[160];
    if (!insists_on_plan(request) && !any_closed(r->mesh)) {
        add_remark(choice, "no component is a closed surface, so there is nothing to cull");
        return true;
    }
    if (charge_pays(r)) {
        if (make_plan(request, CSCD_METHOD_AUTO, r, choice, error)) return true;
        snprintf(choice->remark, sizeof choice->remark, "%.*s", TEXT_CUT(error->text, 590));
    } else {
        snprintf(
            text, sizeof text,
            "a plan by charge takes as long as %d intervals, and here are %u; cscd preprocess makes it once",
            PLAN_PRICE_INTERVALS, r->frame_count - (r->frame_count > 0));
        add_remark(choice, text);
    }
    return make_plan(request, CSCD_METHOD_SINGLE, r, choice, error) || !insists_on_plan(request);
}

bool plan_choose(const plan_request *request, const recording *r, plan_choice *out, io_error *error) {
    method_facts facts = method_facts_of(request->method);
    plan_choice choice = {.method = facts.by_regions ? CSCD_METHOD_NONE : request->method};
    bool chosen = true;
    if (!facts.by_regions) {
        /* as asked for */
    } else if (request->min_separation > 0.0) {
        add_remark(&choice, "with --min-separation nothing is culled");
    } else if (request->plan_path != NULL) {
        chosen = read_named(request, r, &choice, error);
    } else {
        bool any_plan = !facts.makes_plan;
        if (any_plan || facts.by_charge) try_model_plan(request, r, &choice);
        if (choice.plan == NULL)
            chosen = any_plan ? make_best(request, r, &choice, error)
                              : make_plan(request, request->method, r, &choice, error);
    }
    bool adapts = request->method == CSCD_METHOD_AUTO && choice.plan != NULL;
    choice.steps_by = adapts ? CSCD_METHOD_AUTO : choice.method;
    if (chosen) *out = choice;
    return chosen;
}

void plan_choice_free(plan_choice *choice) {
    cscd_plan_destroy(choice->plan);
    free(choice->path);
    *choice = (plan_choice){0};
}

void plan_choice_print(const plan_choice *choice) {
    printf("plan: ");
    if (choice->plan == NULL) {
        printf("none");
    } else {
        uint32_t regions = cscd_plan_region_count(choice->plan);
        printf("%s, %u region%s, ", cscd_method_name(cscd_plan_method(choice->plan)), regions,
               regions == 1 ? "" : "s");
        if (choice->source == PLAN_FROM_FILE)
            printf("from %s", choice->path);
        else
            printf("made in memory in %.2f s", choice->made_ms * 1e-3);
    }
    if (choice->remark[0] != '\0') printf(" (%s)", choice->remark);
    putchar('\n');
}

/* ---- how stiff the material of a recording is ---------------------------------------------------------- */

static const recorded_object *find_stiff(const recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].file.stiffness != NULL) return &r->objects[i];
    return NULL;
}

static bool read_triangle(const recording *r, uint32_t t, recorded_stiffness *s, io_error *error) {
    const recorded_object *object = &r->objects[recording_object_of_triangle(r, t)];
    s->of_triangle[t] = 1.0;
    if (object->file.stiffness == NULL) return true;
    const double value = object->file.stiffness[recording_file_triangle(r, t)];
    if (!(value > 0.0 && value <= DBL_MAX))
        return io_fail(error, "%s: the stiffness of face %u is %g, expected a positive finite number",
                       object->source.model_path, recording_file_face(r, t), value);
    s->of_triangle[t] = value;
    s->least = fmin(s->least, value);
    s->greatest = fmax(s->greatest, value);
    return true;
}

bool recorded_stiffness_read(const recording *r, recorded_stiffness *out, io_error *error) {
    const uint32_t count = cscd_mesh_triangle_count(r->mesh);
    const recorded_object *first = find_stiff(r);
    recorded_stiffness s = {.least = INFINITY};
    *out = (recorded_stiffness){0};
    if (first == NULL) return true;
    s.path = first->source.model_path;
    s.of_triangle = malloc(((size_t)count + 1) * sizeof *s.of_triangle);
    bool read = s.of_triangle != NULL || io_fail(error, "out of memory");
    for (uint32_t t = 0; t < count && read; t++) read = read_triangle(r, t, &s, error);
    if (read)
        *out = s;
    else
        free(s.of_triangle);
    return read;
}

void recorded_stiffness_free(recorded_stiffness *s) {
    free(s->of_triangle);
    *s = (recorded_stiffness){0};
}

/* ---- colours ------------------------------------------------------------------------------------------- */

typedef struct charged_triangle {
    uint32_t component, triangle;
    double charge;
} charged_triangle;

static int compare_charges(const void *left, const void *right) {
    const charged_triangle *l = left, *r = right;
    if (l->component != r->component) return l->component < r->component ? -1 : 1;
    if (l->charge != r->charge) return l->charge < r->charge ? -1 : 1;
    return l->triangle < r->triangle ? -1 : l->triangle > r->triangle;
}

double *charge_ranks(const cscd_plan *plan, const cscd_mesh *mesh) {
    uint32_t count = cscd_mesh_triangle_count(mesh);
    charged_triangle *order = io_realloc(NULL, (size_t)count * sizeof *order);
    double *ranks = io_realloc(NULL, (size_t)count * sizeof *ranks);
    if (order == NULL || ranks == NULL) {
        free(order);
        free(ranks);
        return NULL;
    }
    for (uint32_t t = 0; t < count; t++)
        order[t] =
            (charged_triangle){cscd_mesh_triangle_component(mesh, t), t, cscd_plan_triangle_charge(plan, t)};
    qsort(order, count, sizeof *order, compare_charges);
    for (uint32_t i = 0, first = 0, rank = 0; i < count; i++) {
        if (order[i].component != order[first].component) first = rank = i;
        if (order[i].charge != order[rank].charge) rank = i;
        uint32_t others = cscd_mesh_component(mesh, order[i].component).triangle_count - 1;
        ranks[order[i].triangle] = others > 0 ? (double)(rank - first) / others : 0.0;
    }
    free(order);
    return ranks;
}

bool plan_colour_charge(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours) {
    double *ranks = charge_ranks(plan, mesh);
    if (ranks == NULL) return false;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++)
        picture_colour_map(ranks[t], colours + (size_t)t * 3);
    free(ranks);
    return true;
}

bool plan_colour_density(const cscd_plan *plan, const cscd_mesh *mesh, uint8_t *colours) {
    const uint32_t components = cscd_mesh_component_count(mesh), count = cscd_mesh_triangle_count(mesh);
    double(*ends)[2] = io_realloc(NULL, (size_t)components * sizeof *ends);
    if (ends == NULL) return false;
    for (uint32_t c = 0; c < components; c++) {
        ends[c][0] = INFINITY;
        ends[c][1] = -INFINITY;
    }
    for (uint32_t t = 0; t < count; t++) {
        double *end = ends[cscd_mesh_triangle_component(mesh, t)];
        end[0] = fmin(end[0], cscd_plan_triangle_charge(plan, t));
        end[1] = fmax(end[1], cscd_plan_triangle_charge(plan, t));
    }
    for (uint32_t t = 0; t < count; t++) {
        const double *end = ends[cscd_mesh_triangle_component(mesh, t)];
        const double share = (cscd_plan_triangle_charge(plan, t) - end[0]) / (end[1] - end[0]);
        picture_colour_map(end[1] > end[0] ? share : 0.0, colours + (size_t)t * 3);
    }
    free(ends);
    return true;
}

void plan_colour_regions(const cscd_plan *plan, uint32_t triangle_count, uint8_t *colours) {
    for (uint32_t t = 0; t < triangle_count; t++)
        picture_colour_category(cscd_plan_triangle_region(plan, t), colours + (size_t)t * 3);
}
