"""The hysteresis paper rebuilt: virtual bench tests, EMD, three friction models, two optimisers.

Source: "Modelling and identification of the hysteretic dynamics of inerters" (Dahl, LuGre and
Bouc-Wen models of a ball-screw inerter, harmonic tests from 1 to 4 Hz). Its measured data are not
published, so the tests are made here, from the parameters it prints.

    published.py       its tables, and what has to be mended in them
    settings.py        what a study can be asked for
    virtual_tests.py   the bench tests, made by the reference equations
    denoising.py       the ways to clean the force before a fit
    objective.py       the force error over the paper's own parameters
    optimisers.py      sequential quadratic programming and least squares on it
    emd.py             which mode is the force, and what the noise rule leaves
    loops.py           what a loop says, whatever the model
    crossing.py        who made the data, who fits, how far off on a test held out
    protocol.py        the paper's way: fit at 4 Hz, predict 1 to 3 Hz
    starting.py        what the optimisers make of random starts
    bias.py            what denoising does to estimates
    determined.py      which parameters the tests determine
    conclusions.py     the paper's statements, one by one
    study.py           all of it
    tables.py, figures.py, panels.py, page.py, output.py, command.py   how it is shown
"""
