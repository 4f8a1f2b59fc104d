"""
The services of the node: a request becomes a call of the library, the result a response.

A new service is one method of a class in this folder, decorated with `base.service` or
`base.state_service`; its name is the service name, its summary the row in docs/reference.md.
Add the name to config/sros2_policy.xml, and run scripts/write_reference.py.

What may change here: requests and responses.

"""
