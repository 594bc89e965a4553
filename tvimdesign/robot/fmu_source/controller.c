/* Source of the gains: S. Skogestad, J. Process Control 13 (2003) 291 (SIMC); anti-windup by conditional integration:
   K. J. Astrom and T. Hagglund, Advanced PID Control (2006), sec. 3.5; observer with a disturbance as state:
   sec. 4.5. The layer is a column of cells whose states are enthalpies (Voller). */
#include "controller.h"

#include <math.h>

#if CONTROLLED

/* Straight between the rows of a table that rises in x. */
static real between(const double *x, const double *y, int count, real at)
{
    int i = 1;
    while (i < count - 1 && at > x[i]) i++;
    return (real)(y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]));
}

void controller_start(Controller *c, real thermistor)
{
    int i;
    c->sensed = c->near = c->behind = c->ambient = thermistor;
    c->drift = c->integral = c->current = c->time = 0;
    for (i = 0; i < LAYER_CELLS; i++)
        c->enthalpy[i] = between(layer_temperature, layer_enthalpy, LAYER_ROWS, thermistor);
    c->impedance = (real)STIFF;
}

/* Layer's hot face from the thermistor's lag and the current; layer behind it; the joint's impedance. */
static void estimate(Controller *c, real thermistor)
{
    real error = thermistor - c->sensed, flow[LAYER_CELLS + 1], temperature[LAYER_CELLS];
    real sensed = c->sensed, compliance, loss, size;
    int i;
    c->sensed += PERIOD * ((c->near - sensed) / SENSOR_LAG + OBSERVER_SENSED * error);
    c->near += PERIOD * (HEATING * (c->current - BALANCE) + c->drift + OBSERVER_NEAR * error);
    c->drift += PERIOD * OBSERVER_DRIFT * error;
    for (i = 0; i < LAYER_CELLS; i++)
        temperature[i] = between(layer_enthalpy, layer_temperature, LAYER_ROWS, c->enthalpy[i]);
    compliance = between(layer_temperature, layer_structure, LAYER_ROWS, c->near);
    loss = between(layer_temperature, layer_structure_loss, LAYER_ROWS, c->near);
    flow[0] = 2 * LAYER_CONDUCTANCE * (c->near - temperature[0]);
    for (i = 1; i < LAYER_CELLS; i++) flow[i] = LAYER_CONDUCTANCE * (temperature[i - 1] - temperature[i]);
    flow[LAYER_CELLS] = (temperature[LAYER_CELLS - 1] - c->behind) / BEHIND_RESISTANCE;
    for (i = 0; i < LAYER_CELLS; i++) {
        c->enthalpy[i] += PERIOD * (flow[i] - flow[i + 1]) / CELL_MASS;
        compliance += between(layer_temperature, layer_compliance, LAYER_ROWS, temperature[i]) / LAYER_CELLS;
        loss += between(layer_temperature, layer_loss, LAYER_ROWS, temperature[i]) / LAYER_CELLS;
    }
    c->behind += PERIOD * (flow[LAYER_CELLS] - BEHIND_LOSS * (c->behind - c->ambient)) / BEHIND_CAPACITY;
    size = compliance * compliance + loss * loss;
    c->impedance = (real)hypot(SPRINGS + compliance / size, loss / size);
}

real controller_step(Controller *c, real thermistor, real impedance)
{
    real most, hold, share, error, wanted;
    estimate(c, thermistor);
    if (impedance >= STIFF) {   /* cool as the module's own way back does */
        c->integral = c->time = 0;
        return c->current = (real)(c->near > COOLED ? -COOLING : 0);
    }
    if (impedance < SOFT) impedance = (real)SOFT;
    most = between(profile_time, profile_current, PROFILE_ROWS, (real)fmin(c->time, profile_time[PROFILE_ROWS - 1]));
    hold = between(layer_softness, layer_temperature, LAYER_ROWS, 1 / impedance);
    hold = (real)fmin(hold, HOTTEST);
    share = (real)fmin(fmax(log(c->impedance / impedance) / log(BAND), 0), 1);
    error = hold + share * ((real)HOTTEST - hold) - c->near;
    wanted = (real)(BALANCE + GAIN * error + c->integral);
    c->current = (real)fmin(fmax(wanted, 0), most);
    if (c->current == wanted || (wanted > most) == (error < 0)) c->integral += GAIN * PERIOD / INTEGRAL_TIME * error;
    c->time += PERIOD;
    return c->current;
}
#endif
