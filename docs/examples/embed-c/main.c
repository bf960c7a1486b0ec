/* SPDX-License-Identifier: Apache-2.0
 * A loop of 1 kHz around a patch: this program has the device, the patch computes the force. Here the device is a formula
 * that presses a ball 3 mm against a larger one and slides over it; in your program it is what your driver says. */
#include <math.h>
#include <stdio.h>
#include <tactus.h>

static int fail(const tactus_error* error) {
    fprintf(stderr, "%s\n", error->text);
    return 2;
}

int main(void) {
    tactus_error error;
    tactus_patch* patch = tactus_load("touch-sphere", &error);
    if (!patch) return fail(&error);
    const tactus_device device = {.max_force = 8.0, .damping = 2.0};
    if (tactus_attach_hand(patch, "simulated", &device, &error) != 0) return fail(&error);
    tactus_run* run = tactus_start(patch, NULL, &error);
    if (!run) return fail(&error);
    const int hand = tactus_find_hand(run, "simulated", &error);

    double largest = 0.0;
    for (int tick = 0; tick < 3000; ++tick) {
        const double t = 0.001 * tick;
        const double depth = fmin(t, 1.0) * 0.008;  /* from 5 mm above to 3 mm inside */
        tactus_motion motion = {.position = {0.002 * sin(2.0 * t), 0.0, 0.005 - depth},
                                .velocity = {0.004 * cos(2.0 * t), 0.0, t < 1.0 ? -0.008 : 0.0}};
        tactus_move_hand(run, hand, &motion);
        if (tactus_advance(run, 0.001, &error) != 0) return fail(&error);
        double wrench[6];
        tactus_hand_force(run, hand, wrench);
        largest = fmax(largest, fabs(wrench[2]));
        if (tick % 500 == 499) printf("%.3f s: %.3f N\n", tactus_time(run), wrench[2]);
    }
    printf("largest force: %.3f N\n", largest);
    if (tactus_finish(run, &error) != 0) return fail(&error);
    tactus_free_run(run);
    tactus_free_patch(patch);
    return largest > 0.5 && largest <= 8.0 ? 0 : 1;
}
