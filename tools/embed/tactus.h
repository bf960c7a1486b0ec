/* SPDX-License-Identifier: Apache-2.0 */
/* Patches inside another program: a loop of its own that advances them, a game engine, a notebook. Plain C, so that C#,
 * Python and Rust can call it. Link libtactus (pkg-config tactus, or find_package(Tactus)).
 *
 *     tactus_error error;
 *     tactus_patch* patch = tactus_load("touch-sphere", &error);       // a file, or a name in the library
 *     tactus_attach_hand(patch, "hand", NULL, &error);                 // its device is moved by this program
 *     tactus_run* run = tactus_start(patch, NULL, &error);
 *     int hand = tactus_find_hand(run, "hand", &error);
 *     for (;;) {                                                       // the program's own loop, 1 kHz
 *         tactus_move_hand(run, hand, &motion);
 *         if (tactus_advance(run, 0.001, &error) != 0) break;          // error.text says why
 *         double wrench[6];
 *         tactus_hand_force(run, hand, wrench);
 *     }
 *
 * Units are SI: m, rad, s, N, N·m. Functions that return int give 0 or an index, and −1 with `error` filled when they
 * fail; those that return a pointer give NULL then. `error` may be NULL. A patch or a run is used by one thread at a time;
 * a second one gets an error. tactus_move_hand, tactus_hand_force and tactus_newest may be called beside a live run from
 * one other thread each. This header stays source compatible until 1.0. */
#ifndef TACTUS_H
#define TACTUS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_patch tactus_patch;
typedef struct tactus_run tactus_run;

typedef struct tactus_error {
    char text[2048];  /* whole sentences, with the place; of several errors all, one per line */
    char file[512];   /* of the first: the file, or empty */
    int line, column; /* in it, from 1; 0: unknown */
} tactus_error;

/* "0.1.0" */
const char* tactus_version(void);

/* Reads a patch file, or the patch with this name in the library. */
tactus_patch* tactus_load(const char* name_or_path, tactus_error* error);
/* The patch in `toml`; relative paths in it start at `folder` (NULL: the current one). */
tactus_patch* tactus_parse(const char* toml, const char* folder, tactus_error* error);
/* Before tactus_start: "blade.stiffness=0.5 N/mm", as --set of the command. */
int tactus_configure(tactus_patch* patch, const char* setting, tactus_error* error);
/* Before tactus_start: "bone=jaw.vdb", as --asset of the command. Files are read once and kept with the patch. */
int tactus_use_asset(tactus_patch* patch, const char* asset, tactus_error* error);

/* What a program says of the device that it moves. 0: none or unknown. */
typedef struct tactus_device {
    double max_force;  /* N; forces are limited to it */
    double max_torque; /* N·m; 0: three degrees of freedom */
    double damping;    /* N·s/m of the mechanism with a hand on it; it limits the stiffness that a patch may ask for */
    double delay;      /* s from a motion to the force that answers it, outside of the patch */
} tactus_device;
/* The device [devices.NAME] of the patch is moved by tactus_move_hand instead of its driver. `device` NULL: an ideal one,
 * which limits nothing. */
int tactus_attach_hand(tactus_patch* patch, const char* name, const tactus_device* device, tactus_error* error);
/* Runs that were started go on. */
void tactus_free_patch(tactus_patch* patch);

typedef struct tactus_options {
    size_t size;        /* sizeof(tactus_options) */
    double seconds;     /* of tactus_render and of a live run; 0: until tactus_finish */
    uint64_t seed;      /* 0: the patch's */
    const char* folder; /* where recordings, results and summary.json go, made if need be; NULL: nowhere */
    const char* audio;  /* of a live run: "none" (also NULL), "default", "file", or a part of a card's name */
    int live;           /* 1: runs in real time on threads of its own, from tactus_start on */
    int threads;        /* of tactus_render; 0: as many as the machine has */
} tactus_options;

/* Compiles the patch (once for all runs with the same settings), loads its assets and prepares its nodes. Takes as long as
 * that takes. `options` NULL: all 0. */
tactus_run* tactus_start(tactus_patch* patch, const tactus_options* options, tactus_error* error);
/* Runs every activation before the present logical time + `seconds`, on the calling thread, as fast as it can. Allocates
 * and waits for nothing as long as there is no folder and tactus_output asked for no output with `every`. The same bits as
 * tactus_render, however time is divided. Not for a live run. The caller's loop is on the force path: when it stops calling,
 * the caller sees to it that the force ends. */
int tactus_advance(tactus_run* run, double seconds, tactus_error* error);
/* Instead of tactus_advance: the whole run, on several threads. */
int tactus_render(tactus_run* run, tactus_error* error);
/* Logical time, s: of what tactus_advance has run, or of a live run now. */
double tactus_time(tactus_run* run);
/* Sets a parameter, "0.8 N/mm", 3 ms ahead; one on which a force depends comes in gradually. Between two tactus_advance,
 * or in a live run. */
int tactus_set(tactus_run* run, const char* node_and_parameter, const char* value, tactus_error* error);

/* The number of a hand that tactus_attach_hand attached. */
int tactus_find_hand(tactus_run* run, const char* name, tactus_error* error);
typedef struct tactus_motion {
    double position[3];    /* m, device frame */
    double orientation[4]; /* w, x, y, z; of length 1. All 0: not turned */
    double velocity[3];    /* m/s */
    double turning[3];     /* rad/s */
    uint32_t buttons;      /* bit 0: the tool runs */
    int invalid;           /* 1: the device does not know where it is: the force fades */
} tactus_motion;
/* Where the hand is from now on. In a live run a hand that was not moved for 20 ms counts as lost: the force fades. */
void tactus_move_hand(tactus_run* run, int hand, const tactus_motion* motion);
/* Force (N) and torque (N·m) on the hand, device frame, about the origin of its pose. */
void tactus_hand_force(tactus_run* run, int hand, double wrench[6]);

typedef struct tactus_output_info {
    const char* type;         /* "number", "wrench", "signal" … */
    const char* const* names; /* of its columns, "force.x" …; valid as long as the run */
    int columns;
    double rate; /* values per second */
} tactus_output_info;
/* The number of the output "node.port", to read it. `every` 1: all of its values are kept for tactus_fetch from now on; ask
 * before the run begins. Outputs that hold a bone or a scene have no columns and are refused. */
int tactus_output(tactus_run* run, const char* node_and_port, int every, tactus_output_info* info, tactus_error* error);
/* The name of the output with this number among all that have columns, "node.port"; NULL behind the last one. Valid until the
 * next call. */
const char* tactus_output_name(tactus_run* run, int index);
/* The newest value: `columns` numbers. Before the first activation the one it begins with. */
void tactus_newest(tactus_run* run, int output, double* values);
/* The oldest values that were not fetched yet, at most `most`: logical times in s into `times` (`most` numbers, or NULL), rows
 * of `columns` numbers into `values`. Returns how many there were. After tactus_advance, tactus_render, or beside a live run,
 * where values that nobody fetches for long are lost. */
size_t tactus_fetch(tactus_run* run, int output, double* times, double* values, size_t most);
/* How many values tactus_fetch could give now. */
size_t tactus_available(tactus_run* run, int output);

/* Ends the run (a live one, too) and writes what belongs into its folder. The error, if any, says what was not written. */
int tactus_finish(tactus_run* run, tactus_error* error);
/* After tactus_finish: the summary as JSON, as summary.json has it; valid as long as the run. */
const char* tactus_summary(tactus_run* run);
/* After tactus_finish: a hash over every value of every output; equal bits, equal hash. */
uint64_t tactus_hash(tactus_run* run);
void tactus_free_run(tactus_run* run);

/* Node types whose code is in this program. A patch that is loaded later names such a type as any other, and its node
 * runs in tactus_render and tactus_advance. tactus_start refuses it for a live run, because a callback may allocate and
 * wait; a node for live runs is written in C++ (docs/how-to/write-a-node-outside.md). Results have the same bits
 * however time is divided into blocks, if the callback computes a frame from this frame and the ones before it. */

typedef struct tactus_port {
    const char* name; /* unique in the node: letters, digits, '_', '-' */
    const char* type; /* its values, a row per frame:
                       *   "signal"  one float
                       *   "number"  one double
                       *   "ramp"    one double: an input for numbers that a node with signals reads once per sample
                       *   "bool"    one byte, 0 or 1
                       *   "vector"  double x, y, z
                       *   "pose"    double px, py, pz, qw, qx, qy, qz: m and a unit quaternion
                       *   "twist"   double vx, vy, vz, wx, wy, wz: m/s and rad/s
                       *   "wrench"  double fx, fy, fz, tx, ty, tz: N and N·m */
    const char* unit;  /* of a signal, number, ramp or vector, "m/s^2"; wires between different units are refused.
                        * NULL: none */
    const char* about; /* one sentence, or NULL */
    int optional;      /* 1: an input that may stay without a wire */
} tactus_port;

typedef struct tactus_parameter {
    const char* name;
    const char *initial, *lowest, *highest; /* quantities, "0.5 N/mm"; the unit of the first is that of the parameter */
    const char* about;                      /* one sentence, or NULL */
} tactus_parameter;

typedef struct tactus_setup {
    const char* name; /* of the node in the patch; valid during the call */
    double rate;      /* frames per second, as the patch states */
    int max_frames;   /* most frames of a block */
    uint64_t seed;    /* for random numbers that repeat; differs from node to node */
} tactus_setup;

typedef struct tactus_rows {
    void* values;     /* row of the first frame, within the engine's memory; NULL: an optional input without a wire */
    ptrdiff_t stride; /* bytes from row to row; 0: all frames have this row */
} tactus_rows;

/* Frames index … index + frames − 1 of one node. Valid during the call. */
typedef struct tactus_block {
    int64_t index; /* since the start of the run; its logical time is index / rate, s */
    double rate;   /* frames per second */
    int frames;    /* 1 for a node in a group without signals */
    const tactus_rows* inputs;  /* as declared; only to be read */
    const tactus_rows* outputs; /* as declared. Before the call every row has the last value before this block */
    const double* parameters;   /* as declared, SI */
} tactus_block;

typedef struct tactus_node_type {
    size_t size;       /* sizeof(tactus_node_type) */
    const char* name;  /* `type` in a patch: letters, digits, '_', '-' */
    const char* about; /* one sentence, or NULL */
    const tactus_port* inputs;
    int input_count;
    const tactus_port* outputs;
    int output_count;
    const tactus_parameter* parameters;
    int parameter_count;
    /* The callbacks return 0, or another number with the reason in error->text, which ends the run: tactus_start,
     * tactus_advance or tactus_render then fails with this text and the place of the node in the patch. They must not
     * throw C++ exceptions, nor free the run that calls them. Different nodes may be called by different threads at the
     * same time, one node by one thread. */
    void* context; /* valid until the program ends */
    /* Makes the state of one node of one run, within tactus_start. NULL: the state is `context`. */
    int (*prepare)(void* context, const tactus_setup* setup, void** state, tactus_error* error);
    int (*process)(void* state, const tactus_block* block, tactus_error* error);
    /* Within tactus_free_run, or when tactus_start fails. NULL: nothing to free. */
    void (*release)(void* state);
} tactus_node_type;

/* Makes the type known to this program; texts are copied. A type of this name that was declared before is replaced, but
 * not in runs that have begun. At most 256 names; those of Tactus and of plug-ins are refused. Any thread. */
int tactus_declare_node(const tactus_node_type* type, tactus_error* error);

/* Analyses of records in memory: `count` samples at `rate` Hz, all of them finite. Any number of threads may call them. */

/* Power spectral density by Welch's method: half-overlapping Hann segments of `segment` samples (0: 0.75 s, or as long as eight
 * of them fit), each without its mean; the conventions of scipy.signal.welch. Fills at most `most` bins of `frequencies` (Hz) and
 * `density` (unit²/Hz) and returns how many; with `most` 0 it returns how many bins there are. 0: an error. */
size_t tactus_spectrum(const double* samples, size_t count, double rate, size_t segment, double* frequencies,
                       double* density, size_t most, tactus_error* error);

/* What `tactus compare` finds of two vibrations; NaN: not known of these two. */
typedef struct tactus_comparison {
    double delay, correlation;   /* s by which the output lags, and of the waveforms there; NaN: not recorded together */
    double lowest, highest;      /* Hz: the band of all that follows */
    double reference_rms, output_rms;
    double gain_db;              /* that gives the output the reference's power */
    double spectral_distance_db; /* r.m.s. of the logarithmic difference, to 500 Hz */
    double spectral_cosine;      /* 1: equal spectra */
    double touch_cosine, touch_gap_db; /* weighted by how well touch perceives each frequency */
    double spectrogram_similarity;
    double st_sim, spqi, signal_to_noise_db, coherence; /* of takes recorded together */
    double reference_hz, output_hz; /* fundamentals; 0: none */
} tactus_comparison;
/* Takes of at least 0.5 s, of any rates and lengths. */
int tactus_compare(const double* reference, size_t reference_count, double reference_rate, const double* output,
                   size_t output_count, double output_rate, tactus_comparison* comparison, tactus_error* error);

typedef struct tactus_exposure {
    double weighted[3]; /* a_hw of each axis, m/s² */
    double total;       /* a_hv, m/s² */
    double a8;          /* A(8), m/s² */
    double seconds_to_action, seconds_to_limit; /* a day until 2.5 and 5 m/s² of directive 2002/44/EC; infinity: never */
} tactus_exposure;
/* Vibration exposure of the hand (ISO 5349-1) from accelerations in m/s² along three axes. A record below 2.5 kHz ends within the
 * band of the standard: its values are lower bounds. */
int tactus_hand_arm_exposure(const double* const axes[3], size_t count, double rate, double seconds_a_day,
                             tactus_exposure* exposure, tactus_error* error);

/* Triangles with shared vertices, counter-clockwise seen from outside. It need not be closed. */
typedef struct tactus_mesh {
    const double* vertices; /* x, y, z of each, m */
    size_t vertex_count;
    const int32_t* triangles; /* three indices of each, from 0 */
    size_t triangle_count;
} tactus_mesh;

typedef struct tactus_registration {
    /* "fit": clearly better than any other pose. "ambiguous": another one is about as good, as for a shape that is nearly
     * symmetric. "none": no pose brings the surfaces together. */
    const char* verdict;
    double position[3];    /* of the best pose of the moving mesh in the frame of the fixed one, m */
    double orientation[4]; /* w, x, y, z */
    double rms; /* m, of the distances of both surfaces, each limited; if one is a part of the other, only of the part's */
    double median, p90; /* m, of the distances of the moving vertices from the fixed surface */
    double covered;     /* 0 to 1: vertices of the moving mesh within 2 mm of the fixed surface */
    double rival_rms;   /* m, of the best other pose; infinity: none was found */
    double rival_position[3], rival_orientation[4];
} tactus_registration;
/* The rigid pose that brings a mesh onto another one of the same shape, or of a part of it, as `tactus register` finds it.
 * `anywhere` 0: of poses that fit equally well, the one nearest to the given coordinates. Both meshes are 1 mm to 5 m
 * across. Takes seconds. */
int tactus_register(const tactus_mesh* moving, const tactus_mesh* fixed, int anywhere,
                    tactus_registration* registration, tactus_error* error);

/* Contact of two rigid bodies in six degrees of freedom: points on the surface of the moving mesh against the distance
 * field of the fixed one (McNeely, Puterbaugh and Troy 1999), as in patches. Each point is a spring along the gradient
 * of the distance: its force is stiffness · area · depth, where area is the surface that the point represents. */
typedef struct tactus_contact tactus_contact;
typedef struct tactus_contact_settings {
    size_t size;      /* sizeof(tactus_contact_settings) */
    double stiffness; /* N/m per m² of the moving surface; 0: 4e10, 10 N/mm for each point 0.5 mm apart */
    double spacing;   /* m, of the points; 0: 0.5 mm */
    double voxel;     /* m, of the distance field; 0: 0.5 mm */
} tactus_contact_settings;
/* The fixed mesh must be closed, with triangles counter-clockwise seen from outside. `settings` NULL: all 0. Takes up
 * to seconds. The meshes are copied. */
tactus_contact* tactus_make_contact(const tactus_mesh* moving, const tactus_mesh* fixed,
                                    const tactus_contact_settings* settings, tactus_error* error);
typedef struct tactus_contact_sum {
    double wrench[6]; /* on the moving mesh: N, and N·m about the position of its pose; axes of the fixed mesh */
    /* Second derivative of the energy by a small motion of the moving mesh, vx vy vz wx wy wz in m and rad about the
     * position of its pose, row by row: N/m, N/rad, N·m/rad. Without the part of the curvature. */
    double stiffness[36];
    double energy;      /* J */
    double penetration; /* m, of the deepest point */
    int64_t points;     /* that have a force */
} tactus_contact_sum;
/* The contact at `count` poses of the moving mesh in the frame of the fixed one, seven numbers each: px, py, pz in m,
 * qw, qx, qy, qz of length 1. Fills `count` sums. One thread at a time; a second one gets an error. */
int tactus_contact_at(tactus_contact* contact, const double* poses, size_t count, tactus_contact_sum* sums,
                      tactus_error* error);
void tactus_free_contact(tactus_contact* contact);

#ifdef __cplusplus
}
#endif
#endif
