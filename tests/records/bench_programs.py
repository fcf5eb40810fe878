"""Exports of further programs and loggers, as their manuals and examples show them.

All hold the record of `bench_files`; scopes hold volts, whose calibration a user states.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from bench_containers import CONTAINERS
from bench_export import KN, MM, VOLTS, Export, rows, scope, stamps
from bench_files import DISPLACEMENT, FORCE, ROWS, TIME, text

# --- universal testing machines ----------------------------------------------------------------

TESTSUITE = """"Test Run Name:","Run 3"
"Date:","5/3/2024 10:40:52 AM"

"Axial Displacement","Axial Force","Running Time"
"(mm)","(kN)","(sec)\""""
TESTWORKS = '"Crosshead ","Load ","Time "\n"mm","N","sec"'
WAVEMATRIX = (
    '"Total Time (s)","Total Cycles","Elapsed Cycles","Step",'
    '"Position(8800 (0,1):Position) (mm)","Load(8800 (0,1):Load) (kN)"'
)
TRAPEZIUM = '"1 _ 1","",""\n"Time","Force","Stroke"\n"sec","N","mm"'
UTM_CHINESE = "试验编号,20240503-1\n试验日期,2024-05-03\n时间(秒),位移(毫米),试验力(牛)"
UTM_JAPANESE = "試験名,引張1\n\n時間(秒),変位(mm),荷重(N)"
UTM_RUSSIAN = "Образец;1\nВремя, с;Перемещение, мм;Сила, кН"

MACHINES: dict[str, Export] = {
    "mts_testsuite.csv": Export(text(TESTSUITE, rows(MM, KN, TIME))),
    "mts_testworks.txt": Export(text(TESTWORKS, rows(MM, FORCE, TIME))),
    "instron_wavematrix.csv": Export(
        text(WAVEMATRIX, rows(TIME, [f"{k // 314}" for k in range(ROWS)],
                              [f"{k // 314}" for k in range(ROWS)], ["1"] * ROWS, MM, KN))),
    "shimadzu.csv": Export(text(TRAPEZIUM, "\n".join(
        ",".join(f'"{c:.9g}"' for c in row) for row in zip(TIME, FORCE, MM, strict=True)))),
    "chinese_gbk.csv": Export(text(UTM_CHINESE, rows(TIME, MM, FORCE), encoding="gb18030")),
    "japanese_sjis.csv": Export(text(UTM_JAPANESE, rows(TIME, MM, FORCE), encoding="cp932")),
    "russian_1251.csv": Export(
        text(UTM_RUSSIAN, rows(TIME, MM, KN, separator=";", decimal=","), encoding="cp1251")),
    "polish_1250.csv": Export(text("Czas [s];Przemieszczenie [mm];Siła [N]",
                                   rows(TIME, MM, FORCE, separator=";", decimal=","),
                                   encoding="cp1250")),
    "french_latin.csv": Export(text("Temps écoulé (s);Déplacement (mm);Effort (kN)",
                                    rows(TIME, MM, KN, separator=";", decimal=","),
                                    encoding="latin-1")),
    "german_units.csv": Export(text("Zeit in s;Traversenweg in mm;Prüfkraft in N",
                                    rows(TIME, MM, FORCE, separator=";", decimal=","))),
    "named_by_units.csv": Export(text("t [s];s [mm];Kraftmessdose [N]",
                                      rows(TIME, MM, FORCE, separator=";", decimal=","))),
    "spanish_cell.csv": Export(text("Tiempo (s);Desplazamiento (mm);Celda de carga (N)",
                                    rows(TIME, MM, FORCE, separator=";", decimal=","))),
    "numbered.csv": Export(text("Kanal 1;Kanal 2;Kanal 3\ns;mm;N",
                                rows(TIME, MM, FORCE, separator=";"))),
    "behind_blanks.csv": Export(text("Time s,Position mm,Force N", rows(TIME, MM, FORCE))),
    "signs_and_strokes.csv": Export(text("t / s,s / mm,F / kN", rows(TIME, MM, KN))),
    "excel_sep.csv": Export(text("sep=;\nTime [s];Position [mm];Force [N]",
                                 rows(TIME, MM, FORCE, separator=";"))),
}  # fmt: skip

# --- measuring systems -------------------------------------------------------------------------

CATMAN_EXPORT = """HBM catman AP export\t
Datum/Uhrzeit:\t03.05.2024 10:40:52
T0:\t03.05.2024 10:40:52
Messrate:\t1000 Hz
Zeit  1 - Standardmessrate [s]\tWeg_S9 [mm]\tKraft_U10M [kN]"""
DIADEM = "Time;Weg;Kraft\ns;mm;N"
WAVEFORMS = """waveform\t[0]\t[1]
t0\t5/3/2024 10:40:52.000000 AM\t5/3/2024 10:40:52.000000 AM
delta t\t0.001000\t0.001000

time\tDisplacement (mm)\tForce (N)"""
SIGNAL_EXPRESS = """channel names:\tDisplacement\tForce
start times:\t5/3/2024 10:40:52.000\t5/3/2024 10:40:52.000
dt:\t0.001000\t0.001000
data:"""
LVM_MULTI = """LabVIEW Measurement\t
Writer_Version\t2
Reader_Version\t2
Separator\tTab
Decimal_Separator\t,
Multi_Headings\tYes
X_Columns\tMulti
Time_Pref\tAbsolute
***End_of_Header***\t
\t
Channels\t2\t\t\t
Samples\t400\t\t400\t
Date\t2024/05/03\t\t2024/05/03\t
Time\t10:40:52,1234\t\t10:40:52,1234\t
Y_Unit_Label\tmm\t\tN\t
X_Dimension\tTime\t\tTime\t
X0\t0,0E+0\t\t0,0E+0\t
Delta_X\t0,001\t\t0,001\t
***End_of_Header***\t\t\t\t
X_Value\tWeg\tX_Value\tKraft\tComment"""
LVM_NO_TIME = LVM_MULTI.replace("X_Columns\tMulti", "X_Columns\tNo").split("Channels")[0] + (
    "Channels\t2\t\nSamples\t400\t400\nDate\t2024/05/03\t2024/05/03\nY_Unit_Label\tmm\tN\n"
    "X_Dimension\tTime\tTime\nX0\t0,0E+0\t0,0E+0\nDelta_X\t0,001\t0,001\n"
    "***End_of_Header***\t\t\nX_Value\tWeg\tKraft\tComment"
)
TWINCAT = """Name;C:\\Projects\\bench.tcscopex;;
File;C:\\Projects\\bench.svdx;;
Starttime of export;133591632520000000;Freitag, 3. Mai 2024;10:40:52.000
Endtime of export;133591632524000000;Freitag, 3. Mai 2024;10:40:52.400

Name;Weg;Name;Kraft
SymbolComment;;SymbolComment;
Data-Type;LREAL;Data-Type;LREAL
SampleTime[ms];1;SampleTime[ms];1
VariableSize;8;VariableSize;8
SymbolName;MAIN.rWeg;SymbolName;MAIN.rKraft
NetID;5.1.2.3.1.1;NetID;5.1.2.3.1.1
Port;851;Port;851
Offset;0;Offset;0
ScaleFactor;1;ScaleFactor;1
Unit;mm;Unit;N
"""
CONTROLDESK = """type,csv
version,1.0
source,ControlDesk 7.5
author,bench
date,2024-05-03 10:40:52
parameters
x_axis,y_axis
descriptor,time,Position [mm],Load [N]
unit,s,mm,N
trace_values
"""
YOKOGAWA = """"Header Size",16
"Model Name","DL850E"
"Comment",""
"BlockNumber",1
"TraceName","Weg","Kraft"
"BlockSize",400,400
"VUnit","mm","N"
"SampleRate",1.000000E+03,1.000000E+03
"DispBlockSize",400,400
"HResolution",1.000000E-03,1.000000E-03
"HOffset",0.0,0.0
"HUnit","s","s"
"Date","2024/05/03","2024/05/03"
"Time","10:40:52.00000000","10:40:52.00000000"
"Count","",""
"""
GRAPHTEC = """Vendor,GRAPHTEC Corporation
Model,GL980
Version,Ver1.06
Sampling interval,1ms
Total data points,400
Start time,2024-05-03,10:40:52
AMP settings
CH,Signal name,Input,Range,Filter
CH1,Position,DC,10mm,Off
CH2,Load,DC,1kN,Off
Data
Number,Date&Time,ms,CH1,CH2
NO.,Time,ms,mm,N"""
HIOKI = """"File ID","HIOKI 8860 SERIES"
"Title comment",""
"Trigger Time","'24/05/03 10:40:52.000"

"Time[s]","CH1-1[mm]","CH1-2[N]\""""
TOA5 = """"TOA5","bench","CR6","1234","CR6.Std.09","CPU:bench.CR6","555","fast"
"TIMESTAMP","RECORD","Displacement","Force"
"TS","RN","mm","N"
"","","Smp","Smp\""""
MOTEC = """"Format","MoTeC CSV File"
"Venue","Rig","","","Workbook",""
"Sample Rate","1000.000","Hz"
"Duration","0.400","s"
"Range","entire outing"
"Beacon Markers","0"

"Time","Damper Pos FL","Damper Force FL"
"s","mm","N"

"""
POLYTEC = """Source File Name:\tbench.pvd
Signal:\tTime Signal
Point Index:\t1

Time\tVibrometer Velocity\tReference 1 Force
[ s ]\t[ mm/s ]\t[ N ]"""
ZURICH = """% LabOne plotter export
% device: dev1234
time (s);demod position (mm);aux force (N)"""
COMSOL = """% Model: bench.mph
% Date: May 3 2024
% time (s)  displacement (mm)  force (N)"""
TOPS = """Sequence,Data
Latest: Time (s),Latest: Position (m),Latest: Force (N)"""
VELOCITY = -60 * 8 / -60 * 0.02 * 20 / 8 * np.cos(20 * TIME)


def gl_number(values: Any) -> list[str]:
    """Numbers as GRAPHTEC writes them: a sign, blanks, digits."""
    return [f"{'-' if v < 0 else '+'} {abs(v):10.7f}" for v in values]


SYSTEMS: dict[str, Export] = {
    "catman_export.txt": Export(
        text(CATMAN_EXPORT, rows(TIME, MM, KN, separator="\t", decimal=","),
             encoding="latin-1", end="\r\n")),
    "diadem.csv": Export(text(DIADEM, rows(TIME, MM, FORCE, separator=";", decimal=","))),
    "labview_waveforms.txt": Export(
        text(WAVEFORMS, rows(stamps("%m/%d/%Y %H:%M:%S.%%3 AM"), MM, FORCE, separator="\t"))),
    "signal_express.txt": Export(text(SIGNAL_EXPRESS, rows(MM, FORCE, separator="\t")),
                                 ("displacement=Displacement [mm]",)),
    "labview_multi.lvm": Export(text(
        LVM_MULTI, rows(TIME, MM, TIME, FORCE, separator="\t", decimal=",", after="\t"))),
    "labview_no_time.lvm": Export(text(
        LVM_NO_TIME, rows(MM, FORCE, separator="\t", decimal=",", before="\t", after="\t"))),
    "twincat_scope.csv": Export(text(
        TWINCAT, rows(1e3 * TIME, MM, 1e3 * TIME, FORCE, separator=";"))),
    "controldesk.csv": Export(text(CONTROLDESK, rows(TIME, MM, FORCE, before=","))),
    "yokogawa.csv": Export(text(YOKOGAWA, rows(MM, FORCE, before=","))),
    "graphtec.csv": Export(text(GRAPHTEC, rows(
        [f"{k + 1}" for k in range(ROWS)], stamps("%Y/%m/%d %H:%M:%S"),
        [f"{k % 1000:03d}" for k in range(ROWS)], gl_number(MM), gl_number(FORCE)))),
    "hioki.csv": Export(text(HIOKI, rows(TIME, MM, FORCE, form="{:+.9E}")),
                        ("displacement=CH1-1", "force=CH1-2")),
    "campbell_toa5.dat": Export(text(TOA5, rows(
        [f'"{s}"' for s in stamps("%Y-%m-%d %H:%M:%S.%%3")], [f"{k}" for k in range(ROWS)],
        MM, FORCE))),
    "motec.csv": Export(text(MOTEC, "\n".join(
        ",".join(f'"{c:.9g}"' for c in row) for row in zip(TIME, MM, FORCE, strict=True)))),
    "zurich.csv": Export(text(ZURICH, rows(TIME, MM, FORCE, separator=";"))),
    "percent_comments.txt": Export(text(COMSOL, rows(TIME, MM, FORCE, separator="  "))),
    "vernier.csv": Export(text(TOPS.split("\n")[1], rows(TIME, DISPLACEMENT, FORCE))),
    "capstone.csv": Export(text("Time (s) Run #1,Position (m) Run #1,Force (N) Run #1",
                                rows(TIME, DISPLACEMENT, FORCE))),
    "plotjuggler.csv": Export(text("__time,/strut/position,/strut/force",
                                   rows(TIME, DISPLACEMENT, FORCE))),
}  # fmt: skip

# --- oscilloscopes -----------------------------------------------------------------------------

TEK_NEW = """Model,MSO44
Firmware Version,1.44.3.433

Waveform Type,ANALOG,,
Point Format,Y,,
Horizontal Units,s,,
Horizontal Scale,0.04,,
Horizontal Delay,0.0,,
Sample Interval,1e-3,,
Record Length,400,,
Gating,0.0% to 100.0%,,
Vertical Units,V,V,
Label,,,
TIME,CH1,CH2"""
TEK_OLD = [
    "Record Length,4.000000e+02", "Sample Interval,1.000000e-03",
    "Trigger Point,2.000000000000e+02", "", "", "", "Source,CH1", "Vertical Units,V",
    "Vertical Scale,1.000000e+00", "Vertical Offset,0.000000e+00", "Horizontal Units,s",
    "Horizontal Scale,4.000000e-02", "Pt Fmt,Y", "Yzero,0.000000e+00", "Probe Atten,1.000000e+00",
    "Model Number,TDS2014B", "Serial Number,C050312", "Firmware Version,FV:v22.11",
]  # fmt: skip
KEYSIGHT = "x-axis,1,2\nsecond,Volt,Volt"
RIGOL = "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-2.000000e-01,1.000000e-03"
SIGLENT = """Record Length,Analog:400
Sample Interval,1.000000E-03
Vertical Units,CH1:V,CH2:V
Vertical Scale,CH1:1.00,CH2:1.00
Horizontal Units,s
Horizontal Scale,4.00E-02
Model Number,SDS1104X-E
Source,CH1,CH2
Second,Volt,Volt"""
PICO = "Time,Channel A,Channel B\n(ms),(V),(V)\n"
LECROY = """LECROYWS3024,12345,Waveform
Segments,1,SegmentSize,400
Segment,TrigTime,TimeSinceSegment1
#1,03-May-2024 10:40:52,0
Time,Ampl"""


def _tek_old() -> str:
    made = []
    for k in range(ROWS):
        head = TEK_OLD[k] if k < len(TEK_OLD) else ","
        head = head if "," in head else ","
        made.append(f"{head},,{TIME[k]:.12f},{VOLTS[0][k]:.9g},")
    return "\n".join(made)


SCOPES: dict[str, Export] = {
    "tektronix_mso.csv": Export(text(TEK_NEW, rows(TIME - 0.2, *VOLTS)), scope()),
    "tektronix_tds.csv": Export(text("", _tek_old()), ("force=100 N/V * CH1",),
                                refused="no column 'displacement'"),
    "keysight.csv": Export(text(KEYSIGHT, rows(TIME - 0.2, *VOLTS, form="{:+.9E}")),
                           scope("1", "2")),
    "rigol.csv": Export(text(RIGOL, rows([f"{k}" for k in range(ROWS)], *VOLTS, after=",,")),
                        scope()),
    "siglent.csv": Export(text(SIGLENT, rows(TIME - 0.2, *VOLTS)), scope()),
    "picoscope.csv": Export(text(PICO, rows(1e3 * TIME, *VOLTS)),
                            scope("Channel A", "Channel B")),
    "lecroy_one_channel.csv": Export(text(LECROY, rows(TIME, VOLTS[1])),
                                     ("force=100 N/V * Ampl",), refused="no column 'displacement'"),
}  # fmt: skip

# --- what people write themselves ----------------------------------------------------------------


def _arduino_labels() -> str:
    return "\n".join(f"t_ms:{k},pos_mm:{MM[k]:.9g},force_N:{FORCE[k]:.9g}" for k in range(ROWS))


SELF_MADE: dict[str, Export] = {
    "matlab_timetable.csv": Export(text("Time,Displacement_mm,Force_N", rows(
        [f"{t:.9g} sec" for t in TIME], MM, FORCE))),
    "adams.tab": Export(text('"Plot: PLOT_1"\n"A"\t"B"\t"C"\n"TIME (sec)"\t"strut.disp (mm)"\t'
                             '"strut.force (newton)"',
                             rows(TIME, MM, FORCE, separator="\t"))),
    "arduino_csv.log": Export(text("Booting...\nHX711 ready\nmillis,pos_mm,force_N",
                                   rows([f"{k}" for k in range(ROWS)], MM, FORCE))),
    "arduino_labels.txt": Export(text("setup done", _arduino_labels())),
    "arduino_monitor.txt": Export(text("10:40:51.998 -> millis,pos_mm,force_N", "\n".join(
        f"{stamp} -> {k},{MM[k]:.9g},{FORCE[k]:.9g}"
        for k, stamp in enumerate(stamps("%H:%M:%S.%%3"))))),
    "pandas_index.csv": Export(text(",time,displacement,force",
                                    rows([f"{k}" for k in range(ROWS)], TIME, DISPLACEMENT,
                                         FORCE))),
    "r_write_table.txt": Export(text('"time" "displacement" "force"', rows(
        [f'"{k + 1}"' for k in range(ROWS)], TIME, DISPLACEMENT, FORCE, separator=" "))),
    "r_write_csv2.csv": Export(text('"";"time";"displacement";"force"', rows(
        [f'"{k + 1}"' for k in range(ROWS)], TIME, DISPLACEMENT, FORCE, separator=";",
        decimal=","))),
    "numpy_savetxt.txt": Export(text("# time displacement force",
                                     rows(TIME, DISPLACEMENT, FORCE, separator=" ",
                                          form="{:.18e}"))),
    "numbers_only.txt": Export(text("", rows(TIME, DISPLACEMENT, FORCE, separator="\t").strip()),
                               refused="no header"),
    "octave.txt": Export(text(
        "# Created by Octave 8.4.0\n# name: data\n# type: matrix\n# rows: 400\n# columns: 3",
        rows(TIME, DISPLACEMENT, FORCE, separator=" ", before=" ")), refused="no header"),
    "kips.csv": Export(text("Time (sec),Displacement (inches),Load (kip)",
                            rows(TIME, DISPLACEMENT / 0.0254, FORCE / 4448.2216152605))),
    "newton_words.csv": Export(text("elapsed (seconds),stroke (millimeters),load (newtons)",
                                    rows(TIME, MM, FORCE))),
    "unix_time.csv": Export(text("timestamp,position_mm,force_N",
                                 rows([f"{1714725652 + t:.3f}" for t in TIME], MM, FORCE)),
                            within=(2e-12, 1e-8)),
    "unix_milliseconds.csv": Export(text("timestamp_ms,position_mm,force_N", rows(
        [f"{1714725652000 + k}" for k in range(ROWS)], MM, FORCE))),
    "time_zone.csv": Export(text("timestamp,position_mm,force_N", rows(
        stamps("%Y-%m-%d %H:%M:%S.%%3000+02:00"), MM, FORCE))),
    "sensor_log.tsv": Export(text("Sekunden\tHub_mm\tLast_N", rows(TIME, MM, FORCE,
                                                                  separator="\t"))),
}  # fmt: skip

EXPORTS = MACHINES | SYSTEMS | SCOPES | SELF_MADE | CONTAINERS
