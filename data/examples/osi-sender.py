#!/usr/bin/env python3
# A simulator in thirty lines, for `vesper-drive --osi-udp 48198`: two cars in the street of data/rivoli, as OSI messages.
# Needs osi-python (pip install osi-python). SPDX-License-Identifier: MIT
import socket
import time

from osi3.osi_groundtruth_pb2 import GroundTruth
from osi3.osi_object_pb2 import MovingObject

Lights = MovingObject.VehicleClassification.LightState
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
began = time.time()
while (t := time.time() - began) < 60:
    truth = GroundTruth()
    truth.timestamp.seconds, truth.timestamp.nanos = int(t), int(t % 1 * 1e9)
    truth.host_vehicle_id.value = 1  # Vesper looks out of this one
    for number, ahead in ((1, 0), (2, 18)):
        car = truth.moving_object.add()
        car.id.value, car.type = number, MovingObject.TYPE_VEHICLE
        car.vehicle_classification.type = MovingObject.VehicleClassification.TYPE_MEDIUM_CAR
        size, place = car.base.dimension, car.base.position
        size.length, size.width, size.height = 4.4, 1.8, 1.5
        place.x, place.y, place.z = 1.55, 205 + 8 * t + ahead, 0.75  # of the middle of its box; x east, y north, z up
        car.base.orientation.yaw, car.base.velocity.y = 1.5708, 8  # north
        lights = car.vehicle_classification.light_state
        lights.head_light = lights.tail_light = Lights.GENERIC_LIGHT_STATE_ON
        if number == 2:  # a mesh of that street; brakes and indicates, three seconds each
            car.model_reference = "car_traffic_010"
            lights.brake_light_state = (Lights.BRAKE_LIGHT_STATE_OFF, Lights.BRAKE_LIGHT_STATE_NORMAL)[int(t / 3) % 2]
            lights.indicator_state = (Lights.INDICATOR_STATE_LEFT, Lights.INDICATOR_STATE_OFF)[int(t / 3) % 2]
    link.sendto(truth.SerializeToString(), ("127.0.0.1", 48198))
    time.sleep(0.02)
